"""Text files that lie in a tar archive: read without unpacking, in one pass over the archive.

A recording's `part` in recordings.csv names the member. Without a part, the path itself is the
text file. What an archive's names say is never used as a path, and its links are not followed.
"""

from __future__ import annotations

import lzma
import tarfile
import zlib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.text import LARGEST_BYTES, content_of, number, quoted


def read_numbers(path: Path, part: str | None, columns: int) -> NDArray[np.float64]:
    """Return a text file of numbers, (rows, columns), as it lies in an archive or by itself.

    Cells are separated by tabs or spaces. A row with another number of cells, a cell that is
    no finite number, and a member that is not there are errors that name archive, member, line.
    """
    text = _text(path, part)
    place = "" if part is None else f"member {part}, "
    try:
        # Split at once: a loop over lines takes ten times as long for thousands of files.
        rows = [line.split() for line in text.rstrip().splitlines()]
        values = np.array(rows, dtype=np.float64)
        if (
            "_" not in text
            and values.ndim == 2
            and values.shape[1] == columns
            and np.isfinite(values).all()
        ):
            return values
    except ValueError:
        pass
    raise _fault(text, columns, path, place)


def _fault(text: str, columns: int, path: Path, place: str) -> SignkinError:
    """Return the error that names the first line which cannot be used."""
    lines = text.rstrip().splitlines()
    if not lines:
        where = place.removesuffix(", ") or None
        return SignkinError("nothing in it", file=path, place=where, expected="a row a frame")
    for at, line in enumerate(lines, start=1):
        cells = line.split()
        if len(cells) != columns:
            return SignkinError(
                f"{len(cells)} columns",
                file=path,
                place=f"{place}line {at}",
                expected=f"{columns} columns in each line",
            )
        for column, cell in enumerate(cells, start=1):
            if number(cell) is None:
                return SignkinError(
                    f"found {quoted(cell)}",
                    file=path,
                    place=f"{place}line {at}, column {column}",
                    expected="a finite number",
                )
    raise AssertionError("a file without a fault was refused")


def _text(path: Path, part: str | None) -> str:
    if part is None:
        content = content_of(path)
    else:
        state = path.stat()
        members = _members(path, state.st_mtime_ns, state.st_size)
        if part not in members:
            raise SignkinError(
                f"no member {quoted(part)} among {len(members)} in the archive",
                file=path,
                expected=listed(sorted(members), 3),
                todo="Correct the column `part` of recordings.csv.",
            )
        content = members[part]
    try:
        return content.decode("ascii")
    except UnicodeDecodeError:
        where = None if part is None else f"member {part}"
        raise SignkinError(
            "not a text file", file=path, place=where, expected="lines of numbers"
        ) from None


@lru_cache(maxsize=1)
def _members(path: Path, mtime_ns: int, size: int) -> Mapping[str, bytes]:
    """Return every file of an archive by name; one archive is kept, however often asked for."""
    try:
        with tarfile.open(path) as archive:
            files = {}
            room = LARGEST_BYTES
            for member in archive:
                if not member.isfile():
                    continue
                room -= member.size
                if room < 0:  # told by the archive before anything is unpacked
                    raise SignkinError(
                        f"more than {LARGEST_BYTES / 1e6:.0f} MB unpacked",
                        file=path,
                        expected="less, or the files by themselves",
                    )
                files[member.name] = _content(archive, member)
            return files
    except (
        tarfile.TarError, EOFError, OSError, zlib.error, lzma.LZMAError,
        ValueError, ArithmeticError,
    ) as error:  # fmt: skip
        raise SignkinError(
            f"not readable as a tar archive ({error})",
            file=path,
            expected="a whole .tar, .tar.gz, .tar.bz2 or .tar.xz file",
        ) from error


def _content(archive: tarfile.TarFile, member: tarfile.TarInfo) -> bytes:
    file = archive.extractfile(member)
    assert file is not None  # a regular file has content
    return file.read()
