"""Recordings in a storage service, read through a storage plugin of Snakemake.

Snakemake fetches the files that a job wants before it starts, below a folder of its own
(`.snakemake/storage`), and takes them away again. A job reads them there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Any

from signkin.corpus import Corpus
from signkin.errors import SignkinError


def is_address(place: str | None) -> bool:
    """Whether a place is an address (`s3://bucket/folder`), not a folder."""
    return place is not None and "://" in place


@dataclass(frozen=True)
class Remote:
    """What a Snakefile knows of storage.

    storage: Snakemake's function of this name, which makes an input of an address. exists: whether
    there is something at such an input.
    """

    storage: Callable[[str], Any]
    exists: Callable[[Any], bool]
    _known: dict[str, dict[str, Callable[[], Any]]] = field(default_factory=dict)

    def recorded(self, *parts: str) -> Any:
        """Return the input that an address of a recording's file stands for.

        Whether it is there, its time and its size are asked for once a run: Snakemake asks for
        them anew after each job.
        """
        found = self.file(*parts)
        thing = found.flags["storage_object"]
        known = self._known.setdefault(thing.query, {})
        for name in ("exists", "mtime", "size"):
            setattr(thing, name, known.setdefault(name, cache(getattr(thing, name))))
        return found

    def file(self, *parts: str) -> Any:
        """Return the input that an address stands for.

        Raises SignkinError where no plugin knows such addresses.
        """
        from snakemake.exceptions import WorkflowError

        address = "/".join(part.strip("/") for part in parts)
        try:
            return self.storage(address)
        except WorkflowError as error:
            raise SignkinError(
                f"Snakemake has no storage plugin for {address} ({str(error).splitlines()[0]})",
                expected="an address that an installed plugin knows, s3://bucket/folder",
                todo="Install the extra: pip install 'signkin[s3]'.",
            ) from None

    def folder(self, corpus: Corpus, data_dir: str) -> Path | None:
        """Return the folder that a corpus's files are fetched to; None where there are none."""
        names = corpus.files()
        for name in names:
            _refuse_climbing(corpus, name)
        address = self.address(corpus, data_dir)
        if not names or not self.exists(self.recorded(address, names[0])):
            return None
        return Path(self.file(address, "any").flags["storage_object"].local_path()).parent

    @staticmethod
    def address(corpus: Corpus, data_dir: str) -> str:
        """Return the address of a corpus's folder."""
        return f"{data_dir.rstrip('/')}/{corpus.settings.get('data_folder', corpus.name)}"


def _refuse_climbing(corpus: Corpus, name: str) -> None:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        raise SignkinError(
            f"{name} leads out of the corpus's data folder",
            file=corpus.folder / "recordings.csv",
            expected="a file below it",
        )
