"""Times that an ELAN file leaves open: spread evenly between the aligned ones around them.

As ELAN's TimeProposer does, annotations that share an open slot form a chain, whatever their
order in the tier or in TIME_ORDER; TIME_ORDER decides only where chains do not touch. A slot
has one time in all tiers, the one that the uppermost tier gives it.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence

Edge = tuple[str, str]


def fill_open(
    tiers: Sequence[Sequence[Edge]], known: Mapping[str, float | None]
) -> dict[str, float]:
    """Return the times (s) of open slots; those without aligned times around them are missing.

    tiers: the pairs of slots of each tier's annotations, parent tiers first.
    known: time of each slot in TIME_ORDER's order, None where it is open.
    """
    place = {slot: i for i, slot in enumerate(known)}
    times = dict(known)
    filled: dict[str, float] = {}
    for edges in tiers:
        if any(times[slot] is None for edge in edges for slot in edge):
            for slot, time in _fill(edges, times, place).items():
                times[slot] = filled[slot] = time
    return filled


def _fill(
    edges: Sequence[Edge], times: Mapping[str, float | None], place: Mapping[str, int]
) -> dict[str, float]:
    used = sorted((place[s], t) for s in {s for e in edges for s in e}
                  if (t := times[s]) is not None)  # fmt: skip
    chains = sorted(_chains(edges, times), key=lambda chain: _order(chain, times, place, used))
    line = [slot for chain in chains for slot in chain]
    out: dict[str, float] = {}
    low: float | None = None
    run: list[str] = []
    for slot in line:
        time = times[slot]
        if time is None:
            if not run or run[-1] != slot:
                run.append(slot)
            continue
        if low is not None and low <= time:
            for i, open_slot in enumerate(run, start=1):
                out.setdefault(open_slot, low + (time - low) * i / (len(run) + 1))
        low, run = time, []
    return out


def _chains(edges: Sequence[Edge], times: Mapping[str, float | None]) -> list[list[str]]:
    """Return the slots of annotations that follow one another by an open slot they share."""
    leaving: dict[str, list[int]] = {}
    entered = {end for _, end in edges}
    for i in reversed(range(len(edges))):
        leaving.setdefault(edges[i][0], []).append(i)
    done: set[int] = set()
    chains = []
    for i, (start, _) in enumerate(edges):
        if i in done or (times[start] is None and start in entered):
            continue  # in the middle of a chain
        chain, link = [start], i
        while True:
            done.add(link)
            end = edges[link][1]
            chain.append(end)
            onward = [] if times[end] is not None else leaving.get(end, [])
            while onward and onward[-1] in done:
                onward.pop()
            if not onward:
                break
            link = onward.pop()
        chains.append(chain)
    return chains


def _order(
    chain: Sequence[str],
    times: Mapping[str, float | None],
    place: Mapping[str, int],
    used: Sequence[tuple[int, float]],
) -> tuple[float, int, int]:
    """Return the key that puts chains in order of time.

    At one time: what ends there, what starts there, what lies open behind it in TIME_ORDER.
    """
    first = next((slot for slot in chain if times[slot] is not None), None)
    here = place[chain[0]]
    if first is None:
        before = bisect_left(used, (here, -math.inf)) - 1
        return (used[before][1] if before >= 0 else -math.inf, 2, here)
    time = times[first]
    assert time is not None
    return (time, 0 if first != chain[0] else 1, here)
