"""Table 1: utterances with their glosses (Naert et al. 2017)."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.stages.ingest import lead
from signkin.studies.naert2017.tagged import intervals_of
from signkin.tables import ByRecording


def table1(corpus: Corpus, intervals: pd.DataFrame, sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return utterances with their glosses and, where there is a tier for it, a translation.

    Without an utterance tier the translation tier tells the utterances, without both the
    utterance rule that the transitions follow.
    """
    rows = []
    types, tags = ByRecording(sign_types), ByRecording(intervals)
    for name in dict.fromkeys(sign_types["recording"]):
        signs = types[name]
        role = next((r for r in ("utterance", "translation") if r in corpus.tiers), None)
        translations = (
            intervals_of(tags, name, "translation") if "translation" in corpus.tiers else []
        )
        for number, start, end, chosen in _stretches(name, signs, tags, role):
            middle = (start + end) / 2
            text = [t.label for t in translations if t.start_s <= middle < t.end_s]
            rows.append(
                {
                    **lead(corpus, name),
                    "utterance": number,
                    "start_s": start,
                    "end_s": end,
                    "signs": len(chosen),
                    "glosses": " ".join(chosen["gloss"]),
                    "translation": text[0] if text else "",
                }
            )
    return pd.DataFrame(rows, columns=tables.TABLES["table1"].names())


def _stretches(
    name: str, signs: pd.DataFrame, intervals: ByRecording, role: str | None
) -> Iterator[tuple[str, float, float, pd.DataFrame]]:
    """Yield (utterance, start, end, its signs)."""
    if role is None:
        for number, chosen in signs.groupby("utterance", sort=False):
            yield str(number), float(chosen["start_s"].min()), float(chosen["end_s"].max()), chosen
        return
    middle = (signs["start_s"] + signs["end_s"]) / 2
    for number, span in enumerate(intervals_of(intervals, name, role), start=1):
        inside = (middle >= span.start_s) & (middle < span.end_s)
        yield str(number), span.start_s, span.end_s, signs[inside]
