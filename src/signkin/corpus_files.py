"""Whether a corpus's files are in its data folder: there, and not outside of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from signkin.errors import SignkinError

if TYPE_CHECKING:
    from signkin.corpus import Corpus, Entry


def check_files(corpus: Corpus, folder: Path) -> None:
    """Refuse a corpus that names a file that its data folder lacks, or that lies outside of it.

    Where the corpus says `on_error: skip`, that is found when the file is read.
    """
    if corpus.skips:
        return
    for entry in corpus.entries:
        for name in (entry.motion, entry.annotation):
            if name:
                data_file(corpus, folder, entry, name)
        for annotator in corpus.annotators:
            if name := corpus.annotator_file(entry, annotator):
                data_file(corpus, folder, entry, name, annotator)


def data_file(corpus: Corpus, folder: Path, entry: Entry, name: str, annotator: str = "") -> Path:
    """Return the path of a recording's file: one that is there, in the data folder.

    annotator: whose tags it holds, where corpus.yaml names it. A path that climbs out of the
    folder, and a link that leads out of it or nowhere, are errors: a corpus may come from anywhere.
    """
    path = folder / name
    try:
        there = path.is_file() or path.is_dir()
        outside = not path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError) as error:  # links in a ring, zero bytes
        there, outside, path = False, False, Path(f"{folder}/{name!r} ({type(error).__name__})")
    if annotator:
        file, place = "corpus.yaml", f"key annotation.annotators.{annotator}, {entry.recording}"
    else:
        file, place = "recordings.csv", f"line {entry.line}"
    if outside:
        raise SignkinError(
            f"{name} leads out of the data folder {folder}",
            file=corpus.folder / file,
            place=place,
            expected="a file below it",
            todo="Copy or link the files into the data folder itself.",
        )
    if not there:
        raise SignkinError(
            f"there is no file {path}",
            file=corpus.folder / file,
            place=place,
            expected="the annotator's file" if annotator else "the recording's file",
            todo="Put it there; with `on_error: skip` in corpus.yaml a recording may lack files.",
        )
    return path
