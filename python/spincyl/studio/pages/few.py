"""Numbers and surfaces in few bytes, for the page."""

from base64 import b64encode
from typing import Any

import numpy as np

from spincyl.studio.shape import Part, Profile


def corners(profile: Profile) -> list[tuple[float, ...]]:
    """Corners of a profile as lists; for a smooth profile with their normals, rounded to 1e-6."""
    if profile.normals is None:
        return profile.corners  # type: ignore[return-value]
    pairs = zip(profile.corners, profile.normals, strict=True)
    return [tuple(round(x, 6) for x in (*corner, *normal)) for corner, normal in pairs]


def packed_part(part: Part) -> dict[str, Any]:
    """A part in few bytes: positions in 16 bits, normals in 8."""
    # slightly more than the smallest unit that fits
    unit = float(f"{np.abs(part.vertices).max() / 32500:.3g}")
    return {
        "colour": part.colour,
        "unit": unit,
        "v": base64(np.round(part.vertices / unit), "<i2"),
        "n": base64(np.round(part.normals * 127), "i1"),
        "i": base64(part.triangles, "<u2"),
    }


def base64(values: Any, dtype: str) -> str:
    """An array of numbers of type `dtype`, in base 64."""
    return b64encode(np.ascontiguousarray(values, dtype).tobytes()).decode("ascii")
