"""The sign of a take without tags: the stretch between two rest parts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import hands_of
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import stretches
from signkin.recording import Recording
from signkin.stages.ingest import lead
from signkin.studies.naert2017.settings import SynthesisSettings

FOUND = "between rest parts, by the wrists"


def found_signs(
    corpus: Corpus, takes: Sequence[Recording], settings: SynthesisSettings
) -> pd.DataFrame:
    """Return the table `found_signs`.

    corpus.yaml (`synthesis.signs`) says which takes hold one sign each, with its gloss and, where
    motion is not to be asked, its interval.
    """
    known = corpus.settings.get("synthesis", {}).get("signs", {})
    unknown = sorted(set(known) - {take.name for take in takes})
    if unknown:
        raise SignkinError(
            f"no recording {', '.join(unknown)}",
            file=corpus.folder / "corpus.yaml",
            place="key synthesis.signs",
            expected=f"one of {', '.join(take.name for take in takes)}",
        )
    rows = []
    for take in takes:
        if take.name not in known:
            continue
        told = known[take.name]
        if "start_s" in told:
            start, end, source = told["start_s"], told["end_s"], "corpus.yaml"
        else:
            start, end = between_rests(take, settings)
            source = "motion"
        rows.append(
            {
                **lead(corpus, take.name),
                "gloss": told.get("gloss", take.name),
                "start_s": start,
                "end_s": end,
                "source": source,
                "note": FOUND if source == "motion" else "",
            }
        )
    return pd.DataFrame(rows, columns=tables.TABLES["found_signs"].names())


def between_rests(take: Recording, settings: SynthesisSettings) -> tuple[float, float]:
    """Return start and end (s) of the sign of a take: one sign between two rest parts.

    The take's longest stretch with a hand raised that neither begins nor ends it; within it, from
    where the raising has come to its end to where the lowering begins.
    """
    rules, rate = settings.synthesis, take.rate_hz
    paths = {
        hand: lowpass(take.track(f"{hand}_wrist"), rate, **dict(settings.kinematics.lowpass))
        for hand in hands_of(take.joints)
    }
    heights = np.stack([paths[hand][:, 2] for hand in paths])
    height = np.nanmax(heights, axis=0)
    low, high = np.nanmin(height), np.nanmax(height)
    raised = height > low + rules.found_raised * (high - low)
    runs = [(a, b) for a, b in stretches(raised) if a > 0 and b < take.frames]
    if not runs:
        raise SignkinError(
            "no stretch with raised hands between two rest parts",
            file=f"recording {take.name}",
            expected="one sign with the hands down before and after it",
            todo="Give its interval in corpus.yaml: synthesis.signs.",
        )
    first, end = max(runs, key=lambda run: run[1] - run[0])
    busier = max(paths, key=lambda hand: float(np.nanmean(paths[hand][first:end, 2])))
    moving = speed(paths[busier], rate)
    return (
        _settled(moving, first, 1, rules.found_still) / rate,
        _settled(moving, end - 1, -1, rules.found_still) / rate,
    )


def _settled(moving: np.ndarray, frame: int, step: int, share: float) -> int:
    """Return the first frame from `frame` on (or back) that is slow against the peak before it."""
    fastest = moving[frame]
    while 0 < frame < len(moving) - 1:
        fastest = max(fastest, moving[frame])
        if moving[frame] < share * fastest:
            break
        frame += step
    return frame
