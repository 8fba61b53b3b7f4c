"""Tags and speed minima, against nulls that keep the structure (Naert et al. 2017, 4.1)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.settings.sections import Refinement
from signkin.statistics import nulls
from signkin.statistics.multiplicity import holm_of
from signkin.studies.naert2017.sampling import Sample
from signkin.studies.naert2017.tagged import hands_tagged, signs_of_hand
from signkin.tables import ByRecording

ALL, TRANSITION = "all", "transition"


def tag_chance(
    corpus: Corpus,
    about: pd.DataFrame,
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    chosen: Sample,
    settings: Refinement,
    seed: int,
) -> pd.DataFrame:
    """Return the table `tag_chance`: manual tags of a corpus against each null, by hand.

    Each hand's tags against its own minima: a tier of one hand alone tells nothing of the other.
    about: the table `recordings`. chosen: recordings with tags, in their order.
    """
    rates = about.set_index("recording")["rate_hz"]
    windows = sorted({*nulls.WINDOWS_S, settings.search_window_s})
    parts = []
    by_recording, lows = ByRecording(intervals), ByRecording(minima)
    for hand in hands_tagged(corpus):
        found: list[nulls.Stretch] = []
        for name in chosen.names:
            signs = [(s.start_s, s.end_s) for s in signs_of_hand(corpus, by_recording, name, hand)]
            own = lows[name]
            found += nulls.stretches(
                np.array(signs).reshape(-1, 2),
                own.loc[own["hand"] == hand, "minimum_s"].to_numpy(dtype=float),
                float(rates[name]),
                margin_s=windows[-1],
            )
        for tags in (ALL, TRANSITION):
            rng = seeds.stream(seed, corpus.name, hand, tags, "tag_chance")
            parts.append(_rows(found, tags, windows, settings, rng).assign(hand=hand))
    out = chosen.told(pd.concat(parts, ignore_index=True)).assign(corpus=corpus.name)
    one = (out["measure"] == nulls.MEAN_SHARE) & out["p"].notna()
    out.loc[one, "p_holm"] = holm_of(out.loc[one, "p"].to_numpy(dtype=float))
    return out.reindex(columns=tables.TABLES["tag_chance"].names())


def _rows(
    found: list[nulls.Stretch],
    tags: str,
    windows: list[float],
    settings: Refinement,
    rng: np.random.Generator,
) -> pd.DataFrame:
    only, draws = tags == TRANSITION, settings.draws
    try:
        rows = nulls.against_nulls(found, draws, rng, windows, transitions_only=only)
    except SignkinError as error:
        return pd.DataFrame([{"tags": tags, "n": 0, "note": f"not testable: {error.found}"}])
    note = "" if any(len(part.minima_s) for part in found) else "this hand has no speed minimum"
    if only:
        change = nulls.change_against_nulls(found, draws, rng, settings.search_window_s)
        rows = pd.concat([rows, change], ignore_index=True)
    # Infinitely far: a hand that has no minimum near half of the tags.
    numbers = ["value", "chance", "chance_low", "chance_high"]
    rows[numbers] = rows[numbers].replace(np.inf, np.nan)
    return rows.assign(tags=tags, note=note)
