"""Which of a gloss's signs to take: those near to their neighbours (Naert et al. 2017, 5.2).

"This method retrieves a motion from a range of possible motions in order to minimize the average
distance of this motion with the previous and/or following motion."
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.errors import SignkinError

AT_ONCE = 500_000  # distances of joints


@dataclass(frozen=True, eq=False, kw_only=True)
class Candidates:
    """The first and last postures of the N signs that a gloss may be taken from.

    first, last: positions (N, J, 3). first_turns, last_turns: orientations (N, J, 4), or None.
    """

    first: NDArray[np.float64]
    last: NDArray[np.float64]
    first_turns: NDArray[np.float64] | None = None
    last_turns: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        """Return N."""
        return len(self.first)

    def some(self, rows: slice) -> Candidates:
        """Return some of them."""
        turns = (self.first_turns, self.last_turns)
        first_turns, last_turns = (None if t is None else t[rows] for t in turns)
        return Candidates(
            first=self.first[rows], last=self.last[rows],
            first_turns=first_turns, last_turns=last_turns,
        )  # fmt: skip


@dataclass(frozen=True)
class Scale:
    """The ranges that make the two distances comparable (5.1): by default plain metres.

    The paper takes the mean off as well; over transitions of equal number that changes no
    choice. geodesic_rad None: Euclidean distance only.
    """

    euclidean: float = 1.0
    geodesic_rad: float | None = None


def distances(before: Candidates, after: Candidates, scale: Scale) -> NDArray[np.float64]:
    """Return the mean distance from each last posture to each first posture, (N before, N after).

    Pairs with gaps at every joint are infinitely far. Some rows at a time: of all pairs at once,
    those of a thousand signs would take gigabytes.
    """
    rows = max(1, AT_ONCE // max(1, len(after) * before.last.shape[-2]))
    parts = [
        _distances(before.some(slice(i, i + rows)), after, scale)
        for i in range(0, len(before), rows)
    ]
    return np.concatenate(parts) if parts else np.empty((0, len(after)))


def _distances(before: Candidates, after: Candidates, scale: Scale) -> NDArray[np.float64]:
    values = euclidean_distance(before.last[:, None], after.first[None]) / scale.euclidean
    if (
        scale.geodesic_rad is not None
        and before.last_turns is not None
        and after.first_turns is not None
    ):
        turned = geodesic_distance(before.last_turns[:, None], after.first_turns[None])
        turned = turned / scale.geodesic_rad
        values = np.where(np.isnan(turned), values, (values + turned) / 2)
    return np.where(np.isnan(values), np.inf, values)


def retrieve(
    candidates: Candidates,
    previous: Candidates | None = None,
    following: Candidates | None = None,
    scale: Scale | None = None,
) -> int:
    """Return which candidate has the least mean distance to its neighbours.

    previous, following: the neighbouring signs, one each, or None where there is none. The first
    of equals is taken.
    """
    scale = scale or Scale()
    if not len(candidates):
        raise SignkinError("no candidate", place="retrieval", expected="one sign or more")
    parts = []
    for neighbour in (previous, following):
        if neighbour is not None and len(neighbour) != 1:
            raise SignkinError(
                f"{len(neighbour)} neighbours on one side", place="retrieval", expected="one"
            )
    if previous is not None:
        parts.append(distances(previous, candidates, scale)[0])
    if following is not None:
        parts.append(distances(candidates, following, scale)[:, 0])
    return int(np.argmin(np.mean(parts, axis=0))) if parts else 0


def best_chain(costs: Sequence[NDArray[np.float64]]) -> tuple[list[int], float]:
    """Return the choices that minimise the sum of costs along a sequence, and that sum.

    costs: for each pair of neighbouring places, (candidates before, candidates after). By dynamic
    programming; among equals the one with the earlier candidates from the end on.
    """
    total = np.zeros(len(costs[0])) if costs else np.zeros(1)
    links = []
    for cost in costs:
        through = total[:, None] + cost
        links.append(np.argmin(through, axis=0))
        total = through.min(axis=0)
    chosen = [int(np.argmin(total))]
    for link in reversed(links):
        chosen.append(int(link[chosen[-1]]))
    return chosen[::-1], float(total.min())


def greedy_chain(costs: Sequence[NDArray[np.float64]], first: int = 0) -> tuple[list[int], float]:
    """Return the choices of someone who goes from sign to sign, each time to the nearest."""
    chosen, total = [first], 0.0
    for cost in costs:
        row = cost[chosen[-1]]
        chosen.append(int(np.argmin(row)))
        total += float(row[chosen[-1]])
    return chosen, total
