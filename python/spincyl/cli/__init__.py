"""The command line: steady states as a table, motions as files, the map and other figures as pictures.

Exit status: 0 for success, 1 for a failure of a valid command (a file, a missing extra, memory), 2 for an
invalid command, 130 if interrupted. If a reader such as `head` closes the pipe, that is not a failure.
"""

import contextlib
import os
import sys
from collections.abc import Sequence

from spincyl._input.units import join_units
from spincyl.cli._options import parser

__all__ = ["main"]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    try:
        try:
            return _run(sys.argv[1:] if argv is None else argv)
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except BrokenPipeError:
        _close_stdout()
        return 0
    except OSError as e:  # from the flush
        _close_stdout()
        print(f"spincyl: {e.strerror}", file=sys.stderr)
        return 1


def _run(argv: Sequence[str]) -> int:
    args = parser().parse_args(join_units(argv))
    try:
        args.run(args)
        return 0
    except BrokenPipeError:
        raise
    except (ValueError, TypeError) as e:
        status, said = 2, str(e)
    except OSError as e:
        status, said = 1, f"{e.filename}: {e.strerror}" if e.filename else e.strerror or str(e)
    except (ImportError, MemoryError) as e:
        status, said = 1, str(e) or "not enough memory"
    except KeyboardInterrupt:
        status, said = 130, "interrupted"
    print(f"spincyl {args.command}: {said}", file=sys.stderr)
    return status


def _close_stdout() -> None:
    """Prevent Python from flushing stdout when it ends."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
