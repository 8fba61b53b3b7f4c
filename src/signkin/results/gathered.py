"""Files of shards put together in one folder, without a second copy of them on the disk."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path


def gather_files(folders: Iterable[Path], into: Path) -> None:
    """Put the files of some folders into a new one: by hard link, else by copy.

    Hidden files, which are Snakemake's own marks of each folder, are not taken. Raises
    FileExistsError where two folders hold a file of one name.
    """
    into.mkdir(parents=True)
    for folder in folders:
        for source in sorted(folder.iterdir()):
            if source.name.startswith("."):
                continue
            try:
                os.link(source, into / source.name)
            except FileExistsError:
                raise
            except OSError:  # a file system without hard links, or with as many as it allows
                shutil.copyfile(source, into / source.name)
