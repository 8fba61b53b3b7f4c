"""A whole corpus looked at: every recording's checks, and what to do first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.corpus import Corpus, Entry
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.recording import Recording
from signkin.stages.ingest import of_role, read_entry
from signkin.survey.motion import SIDES, SWAPPED, TEMPO_HZ, motion_notices, noise_sd
from signkin.survey.notices import LEVELS, Notice, judged
from signkin.survey.tags import tag_notices
from signkin.tables import TABLES

MANY = 0.2  # a fault of so many recordings is the corpus's, not theirs
NOISE_FACTOR = 5.0


@dataclass(frozen=True)
class Look:
    """What was found. checks: a row a recording and check (table corpus_checks). recordings: a row
    a recording (table corpus_recordings). first: what to do first, in order. read: how many
    recordings could be read, of `asked`, of `total` that the corpus has."""

    corpus: Corpus
    checks: pd.DataFrame
    recordings: pd.DataFrame
    first: tuple[str, ...]
    read: int
    asked: int
    total: int

    @property
    def wrong(self) -> bool:
        """Whether something is wrong, not just to be looked at."""
        return bool((self.checks["level"] == "wrong").any())


def evenly(entries: Sequence[Entry], most: int | None) -> list[Entry]:
    """Return at most so many entries, evenly over the list."""
    if most is None or len(entries) <= most:
        return list(entries)
    picked = np.unique(np.linspace(0, len(entries) - 1, most).round().astype(int))
    return [entries[i] for i in picked]


def look_at(corpus: Corpus, folder: Path, most: int | None = None) -> Look:
    """Read recordings of a corpus and check them; most: so many, evenly over the list, or all.

    A recording that cannot be read is a finding, and the others go on.
    """
    entries = evenly(corpus.entries, most)
    checks: list[dict[str, object]] = []
    about: list[dict[str, object]] = []
    glosses: Counter[str] = Counter()
    noise: list[float] = []
    crossed: list[float] = []
    for entry in entries:
        lead = {"corpus": corpus.name, "recording": entry.recording, "signer": entry.signer}
        try:
            recording, annotation = read_entry(corpus, folder, entry)
            signs = of_role(corpus, entry, annotation, "sign") if annotation else ()
            notices = motion_notices(recording)
            if corpus.tagged:
                notices += tag_notices(recording, signs)
        except SignkinError as error:
            checks.append({**lead, **_row(Notice("reading", "wrong", 1, "", "", str(error)))})
            continue
        glosses.update(s.label for s in signs)
        noise.append(noise_sd(recording))
        checks += [{**lead, **_row(n)} for n in notices]
        crossed += [n.value for n in notices if n.check == SIDES.format("wrist")]
        about.append({**lead, **_about(recording, len(signs), notices, noise[-1])})
    whole = {"corpus": corpus.name, "recording": "", "signer": ""}
    checks += [{**whole, **_row(n)} for n in _whole(corpus, about, glosses, noise, crossed)]
    frame = pd.DataFrame(checks, columns=TABLES["corpus_checks"].names())
    return Look(
        corpus, frame, pd.DataFrame(about, columns=TABLES["corpus_recordings"].names()),
        tuple(_first(frame, len(entries))), len(about), len(entries), len(corpus.entries),
    )  # fmt: skip


def _row(notice: Notice) -> dict[str, object]:
    return {
        "check": notice.check, "level": notice.level, "value": notice.value, "unit": notice.unit,
        "usual": notice.usual, "todo": notice.todo,
    }  # fmt: skip


def _about(
    recording: Recording, signs: int, notices: Sequence[Notice], noise: float
) -> dict[str, object]:
    by_level = Counter(n.level for n in notices)
    value = {n.check: n.value for n in notices}
    return {
        "frames": recording.frames,
        "rate_hz": recording.rate_hz,
        "duration_s": recording.duration_s,
        "unit": recording.unit,
        "joints": len(recording.joints),
        **{f"missing_{hand}": value.get(f"{hand} wrist, missing", np.nan) for hand in HANDS},
        "tempo_hz": value.get("tempo", np.nan),
        "noise_sd": noise,
        "signs": signs,
        "clock_offset_s": value.get("clock, tags to motion", np.nan),
        "wrong": by_level["wrong"],
        "look": by_level["look"],
    }


def _whole(
    corpus: Corpus, about: Sequence[dict[str, object]], glosses: Counter[str],
    noise: Sequence[float], sides: Sequence[float],
) -> Iterator[Notice]:  # fmt: skip
    """Checks of the corpus as a whole."""
    if not about:
        return
    frame = pd.DataFrame(about)
    tempo = frame["tempo_hz"].dropna()
    if len(tempo):
        middle, (low, high) = float(tempo.median()), TEMPO_HZ
        yield judged(
            "tempo, median of the recordings", middle, "Hz", f"{low:g} to {high:g} Hz",
            not low <= middle <= high,
            "slower or faster than signing everywhere: the rate may be wrong by a factor, or the "
            "takes hold much rest",
        )  # fmt: skip
    if sides:
        share = float(np.mean(np.array(sides) > 0.5))
        yield judged(
            "hands, right of left", share, "share of recordings", "above 50 %", share < 0.5,
            SWAPPED, "wrong",
        )  # fmt: skip
    rates = frame["rate_hz"].nunique()
    yield judged("rates", rates, "rates", "one", rates > 1,
                 "recordings have different rates: meant?")  # fmt: skip
    measured = float(np.nanmedian(noise)) if np.isfinite(noise).any() else float("nan")
    ratio = max(measured / corpus.noise_sd, corpus.noise_sd / measured) if measured > 0 else np.nan
    yield judged(
        "noise_sd, measured", measured, corpus.unit, f"{corpus.noise_sd:g} as corpus.yaml has it",
        bool(ratio > NOISE_FACTOR),
        "third differences of the wrists scatter otherwise; smoothed data show less than the "
        "device has",
    )  # fmt: skip
    if corpus.tagged and glosses:
        untyped = {g: n for g, n in glosses.items() if g not in corpus.lexicon}
        common = ", ".join(g for g, _ in Counter(untyped).most_common(8))
        share = sum(untyped.values()) / sum(glosses.values())
        yield judged(
            "signs without a type in signs.csv", share, "share of signs", "0 %", share > 0,
            f"their types come from motion; the most frequent: {common}",
        )  # fmt: skip


def _first(checks: pd.DataFrame, recordings: int) -> Iterator[str]:
    """Yield what to do first: what is wrong before what to look at, what is everywhere first."""
    for level in LEVELS[:2]:
        bad = checks[checks["level"] == level]
        order = bad["check"].value_counts()
        for check, count in order.items():
            rows = bad[bad["check"] == check]
            where = _where(rows, int(count), recordings)
            yield f"{level}: {check} ({where}): {rows['todo'].iloc[0]}"


def _where(rows: pd.DataFrame, count: int, recordings: int) -> str:
    names = [name for name in rows["recording"] if name]
    if not names:
        return "the corpus"
    if count > max(1, MANY * recordings):
        return f"{count} of {recordings} recordings, e.g. {names[0]}"
    return ", ".join(names[:3]) + (f" and {count - 3} more" if count > 3 else "")
