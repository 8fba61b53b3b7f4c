"""A lock of the operating system on a file: it goes with the process that holds it.

POSIX has it in `fcntl`, Windows in `msvcrt`; neither module is there on the other.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

if sys.platform == "win32":
    import msvcrt

    def _take(file: IO[bytes]) -> None:
        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(file: IO[bytes]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


@contextmanager
def held(path: Path) -> Iterator[int | None]:
    """Hold a lock on a file, made where it is not there, inside a `with`.

    Yields the file descriptor: a child that inherits it holds the lock too (POSIX). Yields None at
    once where another process (or another `held` of this one) has the lock.
    """
    with path.open("ab") as file:
        try:
            _take(file)
        except OSError as error:
            # BlockingIOError on POSIX, PermissionError ("permission denied") from msvcrt.
            if not isinstance(error, BlockingIOError | PermissionError):
                raise
            yield None
        else:
            yield file.fileno()  # closing the file gives the lock back
