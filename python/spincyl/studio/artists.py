"""Matplotlib artists for a frame: shaded triangles, and photographs, as pixels or in a vector drawing.

The classes are made when they are used, since matplotlib need not be installed.
"""

from typing import Any

import numpy as np

from spincyl.studio.painted import Painted

_SUPERSAMPLING = 2  # pixels of Agg for one pixel of the film, along each side, where there are triangles


def photo_of(ax: Any, vector: bool) -> Any:
    """A matplotlib artist that fills the axes with a picture."""
    from matplotlib.artist import Artist

    class Photo(Artist):
        """A picture that is copied to the pixels of Agg, matplotlib's raster renderer."""

        def set_data(self, picture: np.ndarray) -> None:
            self.picture = picture

        def draw(self, renderer: Any) -> None:
            all_of = np.asarray(renderer.buffer_rgba())
            left, top = round(ax.bbox.x0), all_of.shape[0] - round(ax.bbox.y1)
            rows, columns, _ = self.picture.shape
            where = all_of[top : top + rows, left : left + columns, :3]
            where[:] = self.picture[: where.shape[0], : where.shape[1]]

    if vector:
        extent = (*ax.get_xlim(), *ax.get_ylim())
        return ax.imshow(np.zeros((1, 1, 3)), extent=extent, aspect="auto", animated=True, zorder=5)
    photo = Photo()
    photo.set(animated=True, zorder=5)
    ax.add_artist(photo)
    return photo


def surface_of(ax: Any, vector: bool) -> Any:
    """An artist that draws triangles in the given order: shaded, or in plain colours for a vector drawing."""
    from matplotlib.artist import Artist
    from matplotlib.backends.backend_agg import RendererAgg
    from matplotlib.collections import PolyCollection
    from PIL import Image

    class Surface(Artist):
        """Triangles with Gouraud shading, for Agg, matplotlib's raster renderer."""

        def put(self, found: list[Painted]) -> None:
            self.corners, colours = (np.concatenate(x) for x in zip(*found, strict=True))
            self.colours = np.concatenate([colours, np.ones((*colours.shape[:2], 1))], -1)

        def draw(self, renderer: Any) -> None:
            agg: Any = RendererAgg
            picture = np.asarray(renderer.buffer_rgba())
            height, width, _ = picture.shape
            places = ax.transData.transform(self.corners.reshape(-1, 2))
            left, low = np.floor(places.min(axis=0)).astype(int) - 1
            right, high = np.ceil(places.max(axis=0)).astype(int) + 1
            left, right = max(left, 0), min(right, width)
            top, bottom = max(height - high, 0), min(height - low, height)
            if left >= right or top >= bottom:
                return
            where = np.s_[top:bottom, left:right]
            # draw on what is there, at twice the resolution, and average
            wide, tall = right - left, bottom - top
            fine = agg(_SUPERSAMPLING * wide, _SUPERSAMPLING * tall, 100 * _SUPERSAMPLING)
            canvas = np.asarray(fine.buffer_rgba())
            under = picture.view(np.uint32)[where][..., 0]
            canvas.view(np.uint32)[..., 0] = under.repeat(_SUPERSAMPLING, 0).repeat(_SUPERSAMPLING, 1)
            to = ax.transData.frozen().translate(-left, bottom - height).scale(_SUPERSAMPLING)
            graphics = fine.new_gc()
            fine.draw_gouraud_triangles(graphics, self.corners, self.colours, to)
            graphics.restore()
            found = Image.frombuffer(
                "RGBX", (_SUPERSAMPLING * wide, _SUPERSAMPLING * tall), canvas, "raw", "RGBX", 0, 1
            )
            picture[where] = np.asarray(found.reduce(_SUPERSAMPLING))

    class Polygons(PolyCollection):
        """Triangles in plain colours, whose drawn edges close the gaps between them."""

        def put(self, found: list[Painted]) -> None:
            corners, colours = (np.concatenate(x) for x in zip(*found, strict=True))
            self.set(verts=corners, color=colours.mean(axis=1), linewidth=0.8)

    surface: Any = Polygons([]) if vector else Surface()
    surface.set(animated=True, zorder=6)
    ax.add_artist(surface)
    return surface
