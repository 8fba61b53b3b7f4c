"""A seeded sample of a corpus's recordings, for steps whose cost would grow without end.

What is drawn at random or made anew tells as much of some hundreds of transitions as of a million.
A corpus that holds no more than samples.transitions of config.yaml is taken whole.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from signkin import seeds


@dataclass(frozen=True)
class Sample:
    """Recordings of a corpus in its order, and how many there were to draw from."""

    names: tuple[str, ...]
    of: int

    @property
    def whole(self) -> bool:
        """Whether nothing was left out."""
        return len(self.names) == self.of

    @property
    def note(self) -> str:
        """What a table tells of it; nothing of a whole corpus."""
        if self.whole:
            return ""
        return f"of a seeded sample: {len(self.names)} of {self.of} recordings"

    @cached_property
    def _chosen(self) -> frozenset[str]:
        return frozenset(self.names)

    def rows(self, table: pd.DataFrame) -> pd.DataFrame:
        """Return the rows of a table that are of these recordings."""
        return table if self.whole else table[table["recording"].isin(self._chosen)]

    def told(self, table: pd.DataFrame, where: pd.Series | None = None) -> pd.DataFrame:
        """Return a table with the sample told in its notes (where: in some rows)."""
        if self.whole or not len(table):
            return table
        rows = pd.Series(True, index=table.index) if where is None else where
        before = table["note"].fillna("").astype(object)
        joined = before.where(before == "", before + "; ") + self.note
        return table.assign(note=joined.where(rows, table["note"]))


def signs_of(about: pd.DataFrame) -> pd.DataFrame:
    """Return a row a sign, as `sample` counts them, of the table `recordings`."""
    rows = about.loc[about.index.repeat(about["signs"].astype(int)), ["recording"]]
    return rows.assign(role="sign", label="")


def sample(
    corpus: str, names: Iterable[str], intervals: pd.DataFrame, most: int, seed: int,
    glosses: Iterable[str] = (),
) -> Sample:  # fmt: skip
    """Return recordings drawn until they hold so many pairs of neighbouring signs, or all of them.

    The first one drawn is taken however long it is. names: of recordings, in order. intervals: the
    table of that name; where it has no sign at all, a recording counts as one pair. glosses: of
    each that a recording has, one that has it is taken, whatever the sample holds.
    """
    every = list(dict.fromkeys(names))
    signs = intervals[intervals["role"] == "sign"]
    counts = signs["recording"].value_counts().to_dict()
    least = 0 if counts else 1
    pairs = {name: max(int(counts.get(name, 0)) - 1, least) for name in every}
    if sum(pairs.values()) <= most:
        return Sample(tuple(every), len(every))
    order = seeds.stream(seed, corpus, "sample of recordings").permutation(len(every))
    chosen: set[str] = set()
    held = 0
    for i in order:
        if chosen and held + pairs[every[i]] > most:
            break
        chosen.add(every[i])
        held += pairs[every[i]]
    for gloss in glosses:
        having = signs.loc[(signs["label"] == gloss) & signs["recording"].isin(every), "recording"]
        if len(having) and not chosen.intersection(having):
            chosen.add(str(having.iloc[0]))
    return Sample(tuple(name for name in every if name in chosen), len(every))
