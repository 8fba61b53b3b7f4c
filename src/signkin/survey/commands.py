"""`signkin corpus init`, `check`, `list` and `fetch`."""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from signkin.errors import SignkinError

if TYPE_CHECKING:
    from signkin.settings import Settings

RECORDINGS = 100
LINES = 12
EXAMPLES = """examples:
  signkin corpus list
  signkin corpus init ~/recordings/mine
  signkin corpus check mine --data ~/recordings
  signkin corpus check boston104 --data ~/recordings
  signkin corpus check corpora/mine --all
  signkin corpus rate ~/Downloads/ratings-mine.csv
  signkin corpus fetch mine --data ~/recordings
"""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add `corpus` with its own commands to the command line."""
    corpus = commands.add_parser(
        "corpus", help="look at corpora before a run", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    what = corpus.add_subparsers(dest="what", required=True)
    listing = what.add_parser("list", help="the corpora of this folder, and what each is good for",
                              epilog="example: signkin corpus list")  # fmt: skip
    check = what.add_parser("check", help="what is suspicious in a corpus, and what to do first",
                            epilog="example: signkin corpus check mine")  # fmt: skip
    check.add_argument("corpus", help="a corpus of this folder, or the folder of one")
    check.add_argument("--recordings", type=int, default=RECORDINGS,
                       help=f"look at so many, evenly over the list ({RECORDINGS})")  # fmt: skip
    check.add_argument("--all", action="store_true", help="look at all recordings")
    check.add_argument("--out", type=Path, help="folder of the page and tables "
                       "(results/check/<corpus>)")  # fmt: skip
    rate = what.add_parser("rate", help="put ratings that a page saved where the next run reads "
                           "them: exclude leaves a recording or tag out",
                           epilog="example: signkin corpus rate ratings-mine.csv")  # fmt: skip
    rate.add_argument("ratings", type=Path, help="CSV of the page of a corpus")
    first = what.add_parser("init", help="describe a folder of recordings as a corpus",
                            epilog="example: signkin corpus init ~/recordings/mine")  # fmt: skip
    first.add_argument("folder", type=Path, help="folder with the motion and the annotations")
    first.add_argument("--name", help="of the corpus (the folder's name)")
    first.add_argument("--into", type=Path, help="folder of its description (corpora/<name>)")
    get = what.add_parser("fetch", help="get the files of a corpus that have a public address",
                          epilog="example: signkin corpus fetch libras")  # fmt: skip
    get.add_argument("corpus", help="a corpus of this folder")
    for parser in (listing, check, get):
        parser.add_argument("--data", help="folder of the real recordings (else SIGNKIN_DATA)")


def run_corpus(told: argparse.Namespace) -> int:
    """Run one of the commands; returns 1 where something is wrong."""
    try:
        if told.what == "init":
            return init_corpus(told.folder, told.name, told.into)
        if told.what == "rate":
            return rate_corpora(told.ratings)
        if told.what == "fetch":
            return fetch_corpus(told.corpus, told.data)
        return list_corpora(told.data) if told.what == "list" else check_corpus(told)
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1


def _settings() -> Settings:
    """Return config.yaml of the folder that the command is called in; without one, the defaults."""
    from signkin.settings import Settings, load_settings
    from signkin.yaml_file import read_yaml

    config = Path("config.yaml")
    return load_settings(read_yaml(config)) if config.is_file() else Settings()


def _own_folder() -> Path:
    return Path(_settings().corpora_dir)


def _corpora_folder() -> Path:
    """Return where this folder's corpora are described, or those that come with signkin."""
    from signkin.checkout import workflow_home

    own = _own_folder()
    return own if own.is_dir() else workflow_home() / own


def _data_dir(told: str | None) -> str | None:
    """Return the folder of real recordings: as told, else SIGNKIN_DATA, else config.yaml's."""
    from signkin.corpus import data_dir_of

    return told or data_dir_of(_settings().data_dir)


def fetch_corpus(name: str, data: str | None) -> int:
    """Fetch and verify the files of a corpus."""
    from signkin.corpus import load_corpora
    from signkin.survey.fetch import fetch

    corpus = load_corpora(_corpora_folder(), [name])[name]
    folder = corpus.folder / "data"
    if home := _data_dir(data):
        folder = Path(home) / corpus.settings.get("data_folder", corpus.name)
    fetch(corpus, folder, print)
    print(f"Cite: {corpus.settings['citation']} (licence: {corpus.settings['licence']})")
    return 0


def list_corpora(data: str | None) -> int:
    """Print a line a corpus."""
    from signkin.corpus import data_folder, load_corpora

    for name, corpus in load_corpora(_corpora_folder()).items():
        there = data_folder(corpus, _data_dir(data), Path("results")) is not None
        kinds = [
            word
            for word, yes in (
                ("sign tags", corpus.tagged), ("single signs", corpus.single_signs),
                ("simulated", corpus.simulator is not None),
            )
            if yes
        ]  # fmt: skip
        state = "made by the run" if corpus.made_by_run else "there" if there else "no data"
        print(f"{name:14s} {len(corpus.entries):5d} recordings  {state:15s} "
              f"{', '.join(kinds) or 'no tags':26s} {corpus.settings['language']}")  # fmt: skip
    return 0


def rate_corpora(file: Path) -> int:
    """Put the ratings of a file into the corpora that they are of, and print how many."""
    from signkin.ratings import put, read_ratings

    if not file.is_file():
        raise SignkinError("there is no such file", file=file, todo="Save it on a corpus' page.")
    given = read_ratings(file)
    folders = {name: _corpora_folder() / name for name in given}
    for name, folder in folders.items():
        if not (folder / "recordings.csv").is_file():
            raise SignkinError(f"no corpus {name!r}", file=file, expected=f"one of {folder.parent}")
    for name, folder in folders.items():
        counts = put(given[name], folder)
        told = ", ".join(f"{n} {word}" for word, n in sorted(counts.items()))
        print(f"{name}: {told}. Written: {folder / 'recordings.csv'}")
    print("The next run (signkin run) leaves out what is rated exclude, and lists it.")
    return 0


def init_corpus(folder: Path, name: str | None, into: Path | None) -> int:
    """Write the description of a folder; one that is there already is not touched."""
    from signkin.survey.start import start

    if not folder.is_dir():
        raise SignkinError("there is no such folder", file=folder)
    name = name or re.sub(r"[^A-Za-z0-9._-]+", "-", folder.resolve().name).strip("-.")
    into = into or _own_folder() / name
    if (into / "corpus.yaml").exists():
        raise SignkinError(
            "it is there already", file=into / "corpus.yaml", todo="Give another --name or --into."
        )
    found = start(folder.resolve(), name)
    into.mkdir(parents=True, exist_ok=True)
    (into / "corpus.yaml").write_text(found.text, encoding="utf-8")
    (into / "recordings.csv").write_text(found.recordings, encoding="utf-8")
    written = [into / "corpus.yaml", into / "recordings.csv"]
    signs = into / "signs.csv"
    if found.signs and not signs.exists():
        signs.write_text(found.signs, encoding="utf-8")
        written.append(signs)
        kinds = found.signs.count("\n") - 1
        found.asked.append(f"types of {kinds} glosses (signs.csv; empty: typed from motion)")
    print(f"Written: {', '.join(map(str, written))}. To answer in them:")
    for i, question in enumerate(found.asked):
        print(f"{i + 1:3d}. {question}")
    print(f"Then: signkin corpus check {name} --data {folder.resolve().parent}")
    return 0


def check_corpus(told: argparse.Namespace) -> int:
    """Look at a corpus, write the page and the tables, print what to do first."""
    from signkin.corpus import data_folder, load_corpora, load_corpus
    from signkin.corpus_files import check_files
    from signkin.report.page import render
    from signkin.survey.look import look_at
    from signkin.survey.page import look_page
    from signkin.tables import write_table

    given = Path(told.corpus)
    if (given / "corpus.yaml").is_file():
        corpus = load_corpus(given)
    else:
        corpus = load_corpora(_corpora_folder(), [told.corpus])[told.corpus]
    if told.recordings < 1:
        raise SignkinError(f"--recordings {told.recordings}", expected="a whole number from 1")
    folder = data_folder(corpus, _data_dir(told.data), Path("results"))
    if folder is None or not folder.is_dir():
        raise SignkinError(
            f"the recordings of {corpus.name} are not there", place="data",
            expected=f"a folder {corpus.settings.get('data_folder', corpus.name)}",
            todo="Give --data, or set SIGNKIN_DATA.",
        )  # fmt: skip
    check_files(corpus, folder)
    look = look_at(corpus, folder, None if told.all else told.recordings)
    out = told.out or Path("results") / "check" / corpus.name
    out.mkdir(parents=True, exist_ok=True)
    write_table(look.checks, out / "checks.csv", "corpus_checks")
    write_table(look.recordings, out / "recordings.csv", "corpus_recordings")
    (out / "index.html").write_text(render(look_page(look, out), out), encoding="utf-8")
    levels = Counter(look.checks["level"])
    counts = ", ".join(f"{levels[level]} {level}" for level in ("wrong", "look", "fine"))
    print(f"{corpus.name}: {look.read} of {look.asked} recordings read ({look.total} in all)")
    print(f"Checks: {counts}.")
    for i, line in enumerate(look.first[:LINES]):
        print(f"{i + 1:3d}. {line}")
    if len(look.first) > LINES:
        print(f"     and {len(look.first) - LINES} more on the page")
    print(f"The page: {out / 'index.html'}")
    return 1 if look.wrong else 0
