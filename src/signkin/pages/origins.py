"""Provenance: versions, the lock, the commit, checksums of what was read, seeds, the flow."""

from __future__ import annotations

import hashlib
import platform
import re
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

import pandas as pd

import signkin
from signkin import tables
from signkin.checkout import checkout
from signkin.checksum import sha256_of
from signkin.exhibits import exhibits, of_groups
from signkin.pages.sources import Sources
from signkin.pages.times import TIMES
from signkin.report.exhibit_views import exhibit_view
from signkin.report.page import Page, Section, TableView
from signkin.tables import write_table

PROVENANCE = "Provenance"
RUNS = r"extra == .(workflow|cluster|c3d)."  # extras that a run uses; the others are for tests


def origins_page(
    sources: Sources, commit_: str, files: pd.DataFrame, site: list[tuple[str, Path]]
) -> Page:
    """Return the page. files: of `data_files`, written by the caller; commit_: of `commit`."""
    return Page(
        title="Provenance: what this run was made of and with",
        lead=("The same input, settings and versions give the same bytes on any number of cores.",),
        sections=[
            _versions(commit_),
            _data(sources, files),
            _seeds(sources),
            *_flow(sources),
            _cost(sources),
        ],
        version=signkin.__version__,
        site=site,
        here=PROVENANCE,
        docs=sources.docs,
    )


def _versions(commit_: str) -> Section:
    rows = [
        ("signkin", signkin.__version__),
        ("commit", commit_ or "not from a git checkout"),
        ("Python", platform.python_version()),
        ("system", f"{platform.system()} {platform.machine()}"),
    ]
    lock = (checkout() or Path()) / "requirements.lock"
    if lock.is_file():
        rows.append(("SHA-256 of requirements.lock", sha256_of(lock)))
    rows += [(name, there) for name, there in _packages()]
    view = TableView(
        label="", title="Versions", caption="Packages as they are installed where the run was "
        "made; requirements.lock pins them.", frame=pd.DataFrame(rows, columns=["what", "value"]),
        columns={"what": ("what", ""), "value": ("version", "")}, most=60,
    )  # fmt: skip
    return Section("versions", "Versions", exhibits=(view,))


def _packages() -> Iterator[tuple[str, str]]:
    try:
        wanted = distribution("signkin").requires or []
    except PackageNotFoundError:
        wanted = []
    wanted = [text for text in wanted if "extra" not in text or re.search(RUNS, text)]
    names = {re.split(r"[^A-Za-z0-9._-]", requirement, maxsplit=1)[0] for requirement in wanted}
    for name in sorted(names, key=str.lower):
        try:
            yield name, version(name)
        except PackageNotFoundError:
            continue  # of an extra that is not installed


def data_files(sources: Sources) -> pd.DataFrame:
    """Return a row a file that the run read: corpus, file, size, SHA-256."""
    rows = []
    for name, corpus in sources.corpora.items():
        own = [corpus.folder / n for n in ("corpus.yaml", "recordings.csv", "signs.csv")]
        data = sources.data.get(name)
        data_names = corpus.files() if data and not corpus.made_by_run else []
        for label, path in [
            *((f"description/{p.name}", p) for p in own),
            *((n, data / n) for n in data_names if data),
        ]:
            if path.is_file():
                size = path.stat().st_size
                rows.append(
                    {"corpus": name, "file": label, "bytes": size, "sha256": sha256_of(path)}
                )
    return pd.DataFrame(rows, columns=tables.TABLES["data_files"].names())


def write_data_files(sources: Sources, path: Path) -> pd.DataFrame:
    """Write the table of files that were read; returns it."""
    frame = data_files(sources)
    write_table(frame, path, "data_files")
    return frame


def _data(sources: Sources, files: pd.DataFrame) -> Section:
    rows = []
    for name, corpus in sources.corpora.items():
        own = files[files["corpus"] == name]
        text = "\n".join(f"{r.sha256}  {r.file}" for r in own.itertuples())
        rows.append(
            {
                "corpus": name, "licence": corpus.settings["licence"],
                "source": corpus.settings["citation"], "files": len(own),
                "bytes": int(own["bytes"].sum()),
                "sha256": hashlib.sha256(text.encode()).hexdigest()[:16],
            }
        )  # fmt: skip
    view = TableView(
        label="", title="What was read",
        caption="The file has the SHA-256 of every file; here the first 16 digits of that of the "
        "list. Files of simulated corpora are made by the run itself from the seed.",
        frame=pd.DataFrame(rows),
        columns={
            "corpus": ("corpus", ""), "files": ("files", "d"), "bytes": ("bytes", ",d"),
            "sha256": ("SHA-256 of the list", ""), "licence": ("licence", ""),
            "source": ("source", ""),
        },
        file=sources.home / "data_files.csv", most=60,
    )  # fmt: skip
    return Section("data", "Data and checksums", exhibits=(view,))


def _seeds(sources: Sources) -> Section:
    return Section(
        "seeds", "Seeds",
        text=(
            f"One seed, {sources.settings.seed} (config.yaml, seed). Each corpus, recording and "
            "purpose has a random stream of its own, spawned from it by name, so that results "
            "depend neither on the number of cores nor on what else is in the run.",
        ),
    )  # fmt: skip


def _flow(sources: Sources) -> Iterator[Section]:
    for exhibit in of_groups(exhibits(sources.paper), "overview"):
        told = "The rules of this run from raw motion to the report, each after what it needs."
        view = exhibit_view(exhibit, sources.results / "naert2017", told)
        yield Section("flow", "The flow of this run", exhibits=(view,))


def _cost(sources: Sources) -> Section:
    return Section(
        "cost", "Time and memory",
        text=("Every job notes its time and memory; they differ from run to run, so they stand on "
              "a page of their own, which `signkin run` writes at its end.",),
        links=(("Time and memory of each step", sources.results.parent / "logs" / TIMES),),
    )  # fmt: skip
