"""Whether a corpus's files are those it was described with: SHA-256 of files, and of folders."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

from signkin.checksum import sha256_of
from signkin.errors import SignkinError

if TYPE_CHECKING:
    from signkin.corpus import Corpus


def check_checksum(corpus: Corpus, folder: Path, name: str) -> None:
    """Refuse a file that is not the one the corpus was described with."""
    expected = corpus.settings.get("checksums", {}).get(name)
    if expected is None:
        return
    found = digest_of(folder / name)
    if found != expected:
        raise SignkinError(
            f"the SHA-256 of {name} is {found}",
            file=corpus.folder / "corpus.yaml",
            place="key checksums",
            expected=expected,
            todo="Get the file again, or correct the checksum if the change is meant.",
        )


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, or of the names and contents of a folder's files in order."""
    if not path.is_dir():
        return sha256_of(path)
    whole = hashlib.sha256()
    for file in sorted(path.iterdir()):
        if file.is_file():
            whole.update(f"{file.name}\0{sha256_of(file)}\n".encode())
    return whole.hexdigest()
