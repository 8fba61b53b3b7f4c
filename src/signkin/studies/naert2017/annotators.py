"""Signs of further annotators of a corpus, and how far annotators agree, tag by tag."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.stats import t

from signkin import tables
from signkin.annotation import Interval
from signkin.coarticulation.segmentation import EDGES
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io import read_annotation
from signkin.io.registry import wants_rate

LENGTHS_S = (0.3, 0.6)  # short, middling and long signs, by the mean of both annotators
FEWEST = 3  # pairs of a group that is told

Signs = Mapping[str, list[Interval]]  # by recording


def signs_of(
    corpus: Corpus, annotator: str, folder: Path, rates: Mapping[str, float]
) -> tuple[Signs, list[str]]:
    """Return the signs of a further annotator by recording, and what could not be read.

    folder: of the data. rates: frames a second of each recording that is analysed.
    """
    found: dict[str, list[Interval]] = {}
    notes = []
    for name, rate_hz in rates.items():
        entry = corpus.by_name[name]
        spec = corpus.annotator_spec(entry, annotator)
        if wants_rate(str(spec["format"])):
            spec.setdefault("rate_hz", rate_hz)
        try:
            annotation = read_annotation(folder / corpus.annotator_file(entry, annotator), **spec)
        except SignkinError as error:
            notes.append(f"{annotator}, {name}: {error.found}")
            continue
        signs = [i for wish in spec["tiers"] for i in annotation.of(wish)]
        found[name] = sorted(signs or ([] if spec["tiers"] else annotation.intervals))
        if not found[name]:
            notes.append(f"{annotator}, {name}: no sign")
    return found, notes


def pairs_of(first: list[Interval], second: list[Interval]) -> list[tuple[int, int]]:
    """Return which signs of two annotators are one: those that share most time, each once."""
    if not first or not second:
        return []
    a, b = (np.array([(i.start_s, i.end_s) for i in side]) for side in (first, second))
    shared = np.minimum(a[:, None, 1], b[:, 1]) - np.maximum(a[:, None, 0], b[:, 0])
    out: list[tuple[int, int]] = []
    taken_i: set[int] = set()
    taken_j: set[int] = set()
    for cell in np.argsort(-shared, axis=None, kind="stable").tolist():
        i, j = divmod(cell, len(b))
        if shared[i, j] <= 0:
            break
        if i not in taken_i and j not in taken_j:
            out.append((i, j))
            taken_i.add(i)
            taken_j.add(j)
    return sorted(out)


def pair_rows(first: Signs, second: Signs, sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return a row a pair of signs: recording, gloss, length, hands, offset of start and end.

    first: of the corpus's own tags, whose signs have a row in the table `sign_types`.
    """
    types = {(str(r.recording), int(r.sign)): str(r.type) for r in sign_types.itertuples()}
    rows = []
    for name, signs in first.items():
        others = second.get(name, [])
        for i, j in pairs_of(signs, others):
            one, other = signs[i], others[j]
            digits = types.get((name, i + 1), "")
            hands = "" if digits in ("", "nan") else "two" if digits[0] == "1" else "one"
            length = (one.end_s - one.start_s + other.end_s - other.start_s) / 2
            rows.append((name, one.label, _length(length), hands, one.start_s - other.start_s,
                         one.end_s - other.end_s))  # fmt: skip
    return pd.DataFrame(rows, columns=["recording", "gloss", "length", "hands", *EDGES])


def _length(seconds: float) -> str:
    short, long = LENGTHS_S
    if seconds < short:
        return f"under {short:g} s"
    return f"{short:g} to {long:g} s" if seconds < long else f"{long:g} s and more"


def offsets(corpus: str, names: tuple[str, str], pairs: pd.DataFrame) -> pd.DataFrame:
    """Return the table `annotator_offsets` of two annotators. pairs: of `pair_rows`."""
    rows = [
        {"corpus": corpus, "first": names[0], "second": names[1], "edge": edge, "group": group,
         "name": name, **_summary(own[edge].to_numpy(dtype=float), names)}
        for edge in EDGES
        for group, name, own in _groups(pairs)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=tables.TABLES["annotator_offsets"].names())


def _groups(pairs: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    if len(pairs):
        yield "all", "all", pairs
    for group in ("recording", "hands", "length", "gloss"):
        for name, own in pairs[pairs[group] != ""].groupby(group):
            if len(own) >= FEWEST:
                yield group, str(name), own


def _summary(values: np.ndarray, names: tuple[str, str]) -> dict[str, object]:
    n, mean = len(values), float(values.mean())
    sd = float(values.std(ddof=1)) if n > 1 else np.nan
    half = float(t.ppf(0.975, n - 1)) * sd / np.sqrt(n) if n > 1 else np.nan
    low, high = mean - half, mean + half
    lead = names[0] if high < 0 else names[1] if low > 0 else ""
    q5, q25, q75, q95 = np.quantile(values, [0.05, 0.25, 0.75, 0.95])
    return {
        "n": n, "mean_s": mean, "low_s": low, "high_s": high, "sd_s": sd,
        "median_absolute_s": float(np.median(np.abs(values))),
        "q5_s": q5, "q25_s": q25, "q75_s": q75, "q95_s": q95, "lead": lead,
    }  # fmt: skip
