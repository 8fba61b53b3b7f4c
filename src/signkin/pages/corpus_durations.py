"""Durations of a corpus's transitions for its owner: overall, by type, signer and recording."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from signkin import tables
from signkin.resampling import difference
from signkin.seeds import stream

ENOUGH_RECORDINGS = 5  # fewer tell little of how recordings differ
LEAST = 5  # transitions; fewer have no interval to speak of
DRAWS = 1000
SOURCES = {"lexicon": "lexicon", "kinematic": "motion", "": "none"}


def durations_of(corpus: str, transitions: pd.DataFrame, seed: int) -> pd.DataFrame:
    """Return durations of a corpus's transitions between manual tags, a row a group.

    transitions: the table `transitions`. Overlapping signs are left out, transitions of no length
    kept, as in Table 2. From five recordings on, the interval of a mean is a bootstrap of
    recordings; else it is Student's, transitions taken as independent, and the note says so.
    """
    kept = counted(transitions)
    rows: list[dict[str, Any]] = []
    if len(kept):
        rng = stream(seed, "durations", corpus)
        rows += _rows(kept, "all", [("all", kept)], rng)
        rows += _rows(kept, "types from", list(kept.groupby("types_from", sort=True)), rng)
        typed = kept[kept["type"] != ""]
        rows += _rows(kept, "type", _largest(typed.groupby(["type", "types_from"], sort=True)), rng)
        rows += _rows(kept, "signer", list(kept.groupby("signer", sort=True)), rng)
        rows += _rows(kept, "recording", list(kept.groupby("recording", sort=False)), rng)
    frame = pd.DataFrame([{"corpus": corpus, **row} for row in rows])
    return frame.reindex(columns=tables.TABLES["corpus_durations"].names())


def counted(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions that count: between manual tags, whole body, no overlap."""
    kept = transitions[
        (transitions["segmentation"] == "manual")
        & (transitions["hand"] == "both")
        & (transitions["status"] != "overlap")
    ]
    told = kept["type_source"].map(lambda s: SOURCES.get(s, s))
    return kept.assign(types_from=told.where(kept["type"] != "", "none"))


def _largest(groups: Any) -> list[tuple[Any, pd.DataFrame]]:
    return sorted(groups, key=lambda pair: -len(pair[1]))


def _rows(
    kept: pd.DataFrame, group: str, parts: Sequence[tuple[Any, pd.DataFrame]], rng: Any
) -> Iterator[dict[str, Any]]:
    for name, part in parts:
        sources = sorted(set(part["types_from"]))
        yield {
            "group": group,
            "name": name[0] if isinstance(name, tuple) else str(name),
            "types_from": name[1] if isinstance(name, tuple) else ", ".join(sources),
            **_numbers(part, rng),
        }


def _numbers(part: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    values = part["duration_s"].to_numpy(dtype=float)
    n, recordings = len(values), part["recording"].nunique()
    sd = float(values.std(ddof=1)) if n > 1 else float("nan")
    low, high, note = float("nan"), float("nan"), f"fewer than {LEAST} transitions: no interval"
    if recordings >= ENOUGH_RECORDINGS:
        found = difference(
            values, np.zeros(n), {"recording": part["recording"].tolist()}, DRAWS, rng
        )
        low, high, note = found.low, found.high, ""
    elif n >= LEAST:
        half = float(stats.t.ppf(0.975, n - 1)) * sd / n**0.5
        low, high = float(values.mean()) - half, float(values.mean()) + half
        note = (
            "of this recording alone, transitions taken as independent" if recordings == 1
            else f"{recordings} recordings: transitions taken as independent"
        )  # fmt: skip
    median, p5, p95 = np.quantile(values, [0.5, 0.05, 0.95])
    return {
        "n": n, "mean_s": float(values.mean()), "low_s": low, "high_s": high, "sd_s": sd,
        "median_s": float(median), "p5_s": float(p5), "p95_s": float(p95),
        "recordings": recordings, "note": note,
    }  # fmt: skip


def untyped_glosses(sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return the glosses without a type in signs.csv: how often, and which type motion gives.

    agreement: share of a gloss's signs that motion gives its commonest type.
    """
    rows = []
    for gloss, own in sign_types[sign_types["lexicon"] == ""].groupby("gloss", sort=False):
        counts = own["kinematic"].replace("", "none").value_counts()
        rows.append(
            {
                "gloss": gloss,
                "n": len(own),
                "commonest": counts.index[0],
                "agreement": counts.iloc[0] / len(own),
                "recording": own["recording"].iloc[0],
                "start_s": own["start_s"].iloc[0],
            }
        )
    frame = pd.DataFrame(
        rows, columns=["gloss", "n", "commonest", "agreement", "recording", "start_s"]
    )
    return frame.sort_values("n", ascending=False, kind="stable")
