"""Which signing of each gloss an utterance is made of (Naert et al. 2017, 3.1)."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from signkin.coarticulation.retrieval import Scale, best_chain, distances, greedy_chain
from signkin.errors import SignkinError, listed
from signkin.studies.naert2017.synthesis.database import Database


def retrieved(
    base: Database, glosses: Sequence[str], how: str, scale: Scale | None = None
) -> list[int]:
    """Return the token taken for each gloss; how: chain, greedy or first (config's `retrieval`).

    scale: `distance_scale(base)`, where it is known already. An unknown gloss is an error that
    suggests near ones.
    """
    known = base.glosses()
    for gloss in glosses:
        if gloss not in known:
            raise unknown_gloss(gloss, known, base.corpus.name)
    slots = [known[gloss] for gloss in glosses]
    if how == "first":
        return [slot[0] for slot in slots]
    scale = scale or distance_scale(base)
    costs = []
    for before, after in itertools.pairwise(slots):
        cost = distances(base.candidates(before), base.candidates(after), scale)
        same = np.equal.outer(before, after)
        if not same.all():  # a gloss twice: another sign of it, where there is one
            cost = np.where(same, np.inf, cost)
        costs.append(cost)
    if how == "greedy" and len(slots) > 1:
        first = int(np.argmin(costs[0].min(axis=1)))
        chosen, _ = greedy_chain(costs, first)
    else:
        chosen, _ = best_chain(costs)
    return [slot[i] for slot, i in zip(slots, chosen, strict=True)]


def unknown_gloss(gloss: str, known: Mapping[str, Any], corpus: str) -> SignkinError:
    """Return the error of a gloss that does not occur, with those that look like it."""
    folded: dict[str, list[str]] = {}
    for name in known:
        folded.setdefault(name.casefold(), []).append(name)
    near = difflib.get_close_matches(gloss.casefold(), list(folded), n=5, cutoff=0.5)
    names = [name for word in near for name in folded[word]]
    return SignkinError(
        f"the gloss {gloss!r} does not occur",
        file=f"corpus {corpus}",
        expected=f"a gloss of the corpus{'; near ones: ' + listed(names) if names else ''}",
        todo=None if names else f"It has {listed(sorted(known), 30)}.",
    )


def distance_scale(base: Database) -> Scale:
    """Return the ranges of the two distances over the captured transitions (5.1)."""
    pairs = base.pairs()
    if len(pairs) < 2:
        return Scale()
    data = base.features([p.first for p in pairs], [p.second for p in pairs])
    euclidean = float(np.ptp(data.euclidean[np.isfinite(data.euclidean)])) * base.euclidean_unit
    turned = data.geodesic[np.isfinite(data.geodesic)]
    geodesic = float(np.ptp(turned)) if len(turned) else 0.0
    return Scale(euclidean if euclidean > 0 else 1.0, geodesic if geodesic > 0 else None)
