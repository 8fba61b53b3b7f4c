"""Forget compiled kernels of which a source has changed.

numba compiles a function again when its own file is newer than the code it kept, but does not
look at the files of the functions it calls: kernels of several files would keep what they once
took from one another.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

STAMP = "signkin-kernels.sha256"


def forget_stale(folder: Path, sources: Iterable[Path]) -> bool:
    """Delete what numba keeps in a folder for these files, unless they are as they were.

    Returns whether it did. A folder that cannot be written to is left alone: numba keeps nothing
    there.
    """
    files = sorted(sources)
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    now = digest.hexdigest()
    stamp = folder / STAMP
    try:
        if stamp.is_file() and stamp.read_text() == now:
            return False
        folder.mkdir(parents=True, exist_ok=True)
        for file in files:
            for kept in folder.glob(f"{file.stem}.*.nb[ic]"):
                kept.unlink(missing_ok=True)
        fresh = folder / f"{STAMP}.{os.getpid()}"
        fresh.write_text(now)
        fresh.replace(stamp)
    except OSError:
        return False
    return True
