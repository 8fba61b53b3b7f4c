"""The table of a corpus's recordings, and the list of what its owner should look at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables

MUCH_MISSING = 0.05  # of all positions
LONG_GAP_S = 0.5
FAR_BELOW = 3.0  # spreads (1.48 MAD) from the median of all recordings
LEAST_TRANSITIONS = 5  # fewer have no mean to speak of
MOST_TAGS = 100  # worst tags in the list


def overview_of(
    about: pd.DataFrame,
    gaps: pd.DataFrame,
    plausibility: pd.DataFrame,
    durations: pd.DataFrame | None,
    tags: pd.DataFrame | None,
) -> pd.DataFrame:
    """Return a row a recording: rate, gaps, signs, transitions, means and what looks odd.

    The tables `recordings`, `gaps`, `plausibility`, `corpus_durations` and `corpus_tags`; the last
    two are None for a corpus without tags.
    """
    frame = about[["corpus", "recording", "signer", "rate_hz", "duration_s", "signs"]].copy()
    by = gaps.groupby("recording") if len(gaps) else None
    positions = (about["frames"] * about["joints"]).to_numpy(dtype=float)
    missing = _of(frame, by["missing_frames"].sum() if by is not None else None).fillna(0)
    frame["gap_share"] = missing.to_numpy(dtype=float) / np.maximum(positions, 1)
    frame["longest_gap_s"] = _of(frame, by["longest_gap_s"].max() if by is not None else None)
    for column, name in (("transitions", "n"), ("mean_s", None), ("low_s", None), ("high_s", None)):
        own = None
        if durations is not None:
            own = durations[durations["group"] == "recording"].set_index("name")[name or column]
        frame[column] = _of(frame, own)
    near = None
    if tags is not None:
        near = tags[tags["group"] == "recording"].groupby("name")["near"].max()
    frame["near"] = _of(frame, near)
    odd = _oddities(frame, about, plausibility)
    frame["flags"] = [len(odd[name]) for name in frame["recording"]]
    frame["odd"] = ["; ".join(told for _, told in odd[name]) for name in frame["recording"]]
    return frame[tables.TABLES["corpus_overview"].names()]


def _of(frame: pd.DataFrame, values: pd.Series | None) -> pd.Series:
    if values is None:
        return pd.Series(np.nan, index=frame.index)
    return frame["recording"].map(values).astype(float)


Odd = Mapping[str, list[tuple[int, str]]]


def _oddities(frame: pd.DataFrame, about: pd.DataFrame, plausibility: pd.DataFrame) -> Odd:
    """Return recording -> what looks odd in it, each with its rank (1: results may be wrong)."""
    out: dict[str, list[tuple[int, str]]] = {name: [] for name in frame["recording"]}
    for row in plausibility[plausibility["verdict"] == "implausible"].itertuples():
        if row.recording in out:
            out[row.recording].append((1, _implausible(row)))
    for row in frame.itertuples():
        if row.gap_share > MUCH_MISSING:
            out[row.recording].append((2, f"{row.gap_share:.0%} of all positions missing"))
        if row.longest_gap_s > LONG_GAP_S:
            out[row.recording].append((2, f"a gap of {row.longest_gap_s:.2f} s"))
    for row in about.itertuples():
        if row.tags_left_out:
            out[row.recording].append((2, f"{row.tags_left_out} tags left out: {row.tags_note}"))
        if row.times_interpolated:
            told = f"{row.times_interpolated} times of the annotation open, interpolated"
            out[row.recording].append((3, told))
    enough = frame["transitions"] >= LEAST_TRANSITIONS
    for column, told in (
        ("mean_s", "transitions far {word} than in the other recordings: {value:.2f} s on average"),
        ("near", "tags farther from minima than in the other recordings: {value:.0%} near one"),
    ):
        values = frame[column].where(enough)
        spread = 1.4826 * (values - values.median()).abs().median()
        if not spread > 0:
            continue
        away = (values - values.median()) / spread
        wrong = away.abs() > FAR_BELOW if column == "mean_s" else away < -FAR_BELOW
        for name, value, side in zip(
            frame.loc[wrong, "recording"], values[wrong], away[wrong], strict=True
        ):
            word = "longer" if side > 0 else "shorter"
            out[name].append((2, told.format(word=word, value=value)))
    return out


def _implausible(row: Any) -> str:
    if row.low == row.high:  # a count of what should not be there
        return f"{row.check}: {row.value:g} (expected {row.low:g})"
    return f"{row.check}: {_beside(row)} {row.unit} (plausible {row.low:g} to {row.high:g})"


def _beside(row: Any) -> str:
    """Return an implausible value with so many digits that it does not look plausible."""
    for digits in range(3, 8):
        told = f"{row.value:.{digits}g}"
        if not row.low <= float(told) <= row.high:
            return told
    return f"{row.value:g}"


def todo_of(
    overview: pd.DataFrame,
    excluded: pd.DataFrame,
    plausibility: pd.DataFrame,
    worst: pd.DataFrame | None,
    transitions: pd.DataFrame | None,
    outliers: pd.DataFrame | None,
    window_s: float,
) -> pd.DataFrame:
    """Return what the owner should look at, the gravest first.

    worst: of `corpus_tags.worst_tags`; outliers: the table `distances` of Fig. 7; window_s: of
    the refinement. The last three are None for a corpus without tags.
    """
    rows = list(_recordings(overview, excluded, plausibility))
    if worst is not None:
        rows += _tags(worst, window_s)
    if transitions is not None and outliers is not None:
        rows += _transitions(transitions, outliers)
    corpus = overview["corpus"].iloc[0] if len(overview) else ""
    frame = pd.DataFrame([{"corpus": corpus, **row} for row in rows])
    frame = frame.reindex(columns=tables.TABLES["corpus_todo"].names())
    return frame.sort_values("rank", kind="stable", ignore_index=True)


def _row(row: Any, what: str, rank: int, why: str, **more: Any) -> dict[str, Any]:
    start = {"recording": row.recording, "signer": row.signer, "what": what, "rank": rank}
    return {**start, "start_s": np.nan, "end_s": np.nan, "gloss": "", "why": why, **more}


def _recordings(
    overview: pd.DataFrame, excluded: pd.DataFrame, plausibility: pd.DataFrame
) -> Iterator[dict[str, Any]]:
    for row in excluded.itertuples():
        yield _row(row, "recording", 1, f"left out: {row.reason}")
    wrong = set(plausibility.loc[plausibility["verdict"] == "implausible", "recording"])
    for row in overview[overview["flags"] > 0].itertuples():
        yield _row(row, "recording", 1 if row.recording in wrong else 2, row.odd)


def _tags(worst: pd.DataFrame, window_s: float) -> Iterator[dict[str, Any]]:
    far = worst[~(worst["distance_s"] <= window_s + 1e-9)]
    for row in far.head(MOST_TAGS).itertuples():
        told = (
            "no minimum of speed in the recording" if pd.isna(row.distance_s)
            else f"{row.distance_s:.2f} s from the nearest minimum of speed ({row.hand} hand)"
        )  # fmt: skip
        why = f"its {row.edge}, at {row.manual_s:.2f} s, lies {told}"
        span = {"start_s": row.start_s, "end_s": row.end_s, "gloss": row.gloss}
        yield _row(row, "tag", 2, why, **span)


def _transitions(transitions: pd.DataFrame, outliers: pd.DataFrame) -> Iterator[dict[str, Any]]:
    manual = transitions[
        (transitions["segmentation"] == "manual") & (transitions["hand"] == "both")
    ]
    flagged = outliers[outliers["outlier"].astype(str) == "True"]
    far = set(zip(flagged["recording"], flagged["transition"], strict=True))
    for row in manual.itertuples():
        span = {
            "start_s": min(row.start_s, row.end_s), "end_s": max(row.start_s, row.end_s),
            "gloss": f"{row.previous_gloss} → {row.next_gloss}",
        }  # fmt: skip
        if row.status == "overlap":
            why = f"the next sign starts {-row.duration_s:.2f} s before the last one ends"
            yield _row(row, "transition", 2, why, **span)
        elif (row.recording, row.transition) in far:
            why = f"an outlier: it lasts {row.duration_s:.2f} s"
            yield _row(row, "transition", 3, why, **span)
        elif row.status == "zero_length":
            why = "of no length: one sign ends where the next starts"
            yield _row(row, "transition", 3, why, **span)
