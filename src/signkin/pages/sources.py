"""Where the parts of a report lie, and the tables of a run as they were written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import pandas as pd

from signkin.corpus import Corpus
from signkin.settings import Settings
from signkin.studies.naert2017.report import Shown, Source
from signkin.tables import read_table


@dataclass(frozen=True)
class Sources:
    """Where a report's parts lie.

    results: the results folder. corpora: those of this run. missing: corpus -> reason.
    paper, endres: the folders papers/naert2017 and papers/endres2013. settings: config.yaml.
    home: the folder of the pages. data: corpus -> its data folder.
    """

    results: Path
    corpora: Mapping[str, Corpus]
    missing: Mapping[str, str]
    paper: Path
    endres: Path
    settings: Settings
    home: Path
    data: Mapping[str, Path] = field(default_factory=dict)

    @cached_property
    def published_n(self) -> int:
        """Number of transitions in the paper's Table 2."""
        frame = pd.read_csv(self.paper / "table2.csv", dtype=str, keep_default_na=False)
        return int(frame["n"].astype(int).sum())

    def shared(self, corpus: str, table: str) -> Path:
        """Return the file of a table that both studies share."""
        return self.results / corpus / f"{table}.csv"

    def table(self, corpus: str, table: str) -> pd.DataFrame:
        """Return a table that both studies share."""
        return read_table(self.shared(corpus, table), table)

    def tagged_file(self, corpus: str, table: str) -> Path:
        """Return the file of a table of Naert et al.'s study."""
        return self.naert.file(corpus, f"{table}.csv")

    def tagged_table(self, corpus: str, table: str) -> pd.DataFrame:
        """Return a table of Naert et al.'s study."""
        return read_table(self.tagged_file(corpus, table), table)

    @cached_property
    def naert(self) -> Shown:
        """Where the parts of Naert et al. 2017 lie."""
        return Shown(self.results / "naert2017", self.paper, self.corpora, self.settings)

    def naert_source(self, corpus: str) -> Source:
        """Return where the parts of one corpus lie."""
        return Source(self.corpora[corpus], self.naert.file(corpus, ""), self.naert)

    @property
    def docs(self) -> Path | None:
        """The folder of the documents, where the run's folder has one."""
        folder = self.results.parent / "docs"
        return folder if folder.is_dir() else None

    def badge(self, corpus: str) -> str:
        """Return whether a corpus is real or simulated."""
        return "simulated" if self.corpora[corpus].simulator else "real"

    def excerpt(self, corpus: str, recording: str, at_s: float | None = None) -> str:
        """Return the address of a recording's own page, from a page of the folder `corpora`.

        Empty where the recording has no such page. at_s: where it opens.
        """
        place = Path("recordings") / corpus / f"{recording}.html"
        if not (self.home / place).is_file():
            return ""
        where = "" if at_s is None or pd.isna(at_s) else f"#t={at_s:.2f}"
        return f"../{place.as_posix()}{where}"
