"""What the pages of one corpus are made from: its tables, read once, and its settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.explorer.choice import chosen
from signkin.explorer.densities import DensitySettings
from signkin.io.store import recording_names
from signkin.settings import Settings
from signkin.studies.endres2013.settings import CutSettings
from signkin.studies.naert2017.distances import with_flags
from signkin.studies.naert2017.settings import SynthesisSettings

# The tables that a corpus has whatever is in it, and those of corpora with tags or long series.
SHARED = ("recordings", "intervals", "minima", "plausibility", "excluded")
OTHERS = ("boundaries", "boundary_posteriors", "transitions", "synthesis",
          "wrist_boundaries", "wrist_posteriors")  # fmt: skip

# Those that tell which recordings get a page.
CHOOSING = ("recordings", "plausibility", "excluded", "boundaries", "transitions")

NOWHERE_S = 1000.0  # how far from a minimum a tag counts where there is no minimum at all


@dataclass(frozen=True)
class ExplorerSettings:
    """The settings that pages depend on; most_recordings is report.explorer_recordings."""

    most_recordings: int | None
    synthesis: SynthesisSettings
    cut: CutSettings
    densities: DensitySettings

    @classmethod
    def of(cls, settings: Settings) -> ExplorerSettings:
        """Return those of a run."""
        return cls(
            settings.report.explorer_recordings,
            SynthesisSettings.of(settings),
            CutSettings.of(settings),
            DensitySettings.of(settings),
        )


@dataclass(frozen=True, eq=False)
class Sources:
    """A corpus with the files and tables that its pages are made from.

    recordings, frames, posteriors: files of canonical recordings, of kinematics, of binned single
    signs, a shard each. tables: by name; without those that the corpus does not have.
    """

    corpus: Corpus
    settings: ExplorerSettings
    recordings: Sequence[Path]
    frames: Sequence[Path]
    posteriors: Sequence[Path]
    tables: Mapping[str, pd.DataFrame]
    outliers: Mapping[str, list[int]] = field(default_factory=dict)
    _rows: dict[str, dict[str, Any]] = field(default_factory=dict)

    def of(self, table: str, recording: str) -> pd.DataFrame:
        """Return the rows of a recording; no rows of a table that the corpus does not have."""
        frame = self.tables.get(table)
        if frame is None:
            return tables.empty(table, self.corpus.unit)
        if table not in self._rows:  # found once: a corpus may have thousands of recordings
            self._rows[table] = dict(frame.groupby("recording", sort=False).indices)
        return frame.iloc[self._rows[table].get(recording, [])]

    def names(self) -> list[str]:
        """Return the recordings with motion, in the order of the corpus."""
        return [name for path in self.recordings for name in recording_names(path)]

    def shown(self) -> list[str]:
        """Return the recordings that get a page, as many as report.explorer_recordings allows."""
        return chosen(self.names(), self.gravity(), self.settings.most_recordings)

    def troubles(self) -> dict[str, int]:
        """Return how much there is to look at in each recording: recording -> number."""
        found: dict[str, int] = {}
        for rows in self._troubled():
            for name, count in rows["recording"].value_counts().items():
                found[str(name)] = found.get(str(name), 0) + int(count)
        for name, numbers in self.outliers.items():
            found[name] = found.get(name, 0) + len(numbers)
        return found

    def gravity(self) -> dict[str, float]:
        """Return how grave what is to be looked at is: recording -> the higher the graver.

        In the order of the list on the corpus's page: what cannot be right, then the tags that lie
        farthest from a minimum, then how much there is.
        """
        out = {name: count / 1e6 for name, count in self.troubles().items()}
        tags = self.tables.get("boundaries")
        if tags is not None and len(tags):
            nearest = _nearest(tags)
            away = nearest["away"].fillna(NOWHERE_S).where(nearest["far"], 0.0)
            for name, most in away.groupby("recording").max().items():
                out[str(name)] = out.get(str(name), 0.0) + float(most)
        for name in self._wrong()["recording"]:
            out[str(name)] = out.get(str(name), 0.0) + 2 * NOWHERE_S
        return out

    def _wrong(self) -> pd.DataFrame:
        implausible = self.tables["plausibility"]
        return implausible[implausible["verdict"] == "implausible"].drop_duplicates("recording")

    def _troubled(self) -> Iterable[pd.DataFrame]:
        implausible = self.tables["plausibility"]
        yield implausible[implausible["verdict"] == "implausible"]
        yield self.tables["excluded"]
        if len(self.tables.get("transitions", ())) and len(self.tables.get("boundaries", ())):
            rows = self.tables["transitions"]
            whole = (rows["segmentation"] == "manual") & (rows["hand"] == "both")
            yield rows[whole & (rows["status"] != "ok")]
            nearest = _nearest(self.tables["boundaries"]).reset_index()
            yield nearest[nearest["far"]]


def read_sources(corpus: Corpus, settings: ExplorerSettings, files: Mapping[str, Any]) -> Sources:
    """Read what the pages of a corpus are made from.

    files: recordings, frames, posteriors: a file a shard; the tables: a file each, or none for
    those that the corpus does not have.
    """
    paths = {name: _paths(files.get(name)) for name in (*SHARED, *OTHERS)}
    there = [name for name in paths if paths[name]]
    read = {
        name: tables.concatenated(paths[name], name, corpus.unit)
        for name in there
        if name in CHOOSING
    }
    shards = {name: _paths(files.get(name)) for name in ("recordings_of", "frames", "posteriors")}
    whole = Sources(
        corpus=corpus,
        settings=settings,
        recordings=shards["recordings_of"],
        frames=shards["frames"],
        posteriors=shards["posteriors"],
        tables=read,
        outliers=_outliers(read.get("transitions"), settings),
    )
    names = whole.shown()
    for name in there:
        if name not in CHOOSING:  # of thousands of recordings only those with a page
            rows = tables.concatenated(paths[name], name, corpus.unit)
            read[name] = rows[rows["recording"].isin(names)]
    return replace(whole, tables={name: read[name] for name in there})


def _nearest(tags: pd.DataFrame) -> pd.DataFrame:
    """Return of each tag, by recording, sign and edge: far from minima of both hands; away, s."""
    marked = tags.assign(far=tags["status"] == "far")
    return marked.groupby(["recording", "sign", "edge"]).agg(
        far=("far", "all"), away=("distance_s", "min")
    )


def _paths(files: Any) -> list[Path]:
    if not files:
        return []
    return [Path(files)] if isinstance(files, str) else [Path(file) for file in files]


def _outliers(rows: pd.DataFrame | None, settings: ExplorerSettings) -> dict[str, list[int]]:
    """Return the transitions that the outlier rule marks in the corpus, by recording."""
    if rows is None or not len(rows):
        return {}
    chosen = settings.synthesis.transitions
    marked, _ = with_flags(rows, chosen.outlier_iqr, chosen.diamond_share)
    marked = marked[marked["outlier"].astype(bool)]
    return {
        str(name): [int(n) for n in mine["transition"]]
        for name, mine in marked.groupby("recording")
    }
