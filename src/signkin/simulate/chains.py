"""Chains of signs that contain given transitions: trails through a multigraph of sign types."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

Edge = tuple[str, str]


def fewest_chains(counts: Mapping[Edge, int]) -> int:
    """Return the fewest unbroken chains that use every transition once (connected types)."""
    surplus = _surplus(counts)
    return max(1, sum(value for value in surplus.values() if value > 0))


def _surplus(counts: Mapping[Edge, int]) -> Counter[str]:
    surplus: Counter[str] = Counter()
    for (before, after), count in counts.items():
        surplus[before] += count
        surplus[after] -= count
    return surplus


def chains(
    counts: Mapping[Edge, int], number: int, most: int, rng: np.random.Generator
) -> list[list[str]]:
    """Return `number` chains of sign types that together have exactly these transitions.

    counts: (type before, type after) -> number. Each chain has at most `most` transitions,
    so far as `number` allows. Hierholzer's algorithm on the multigraph, closed by links from
    the types where chains must end to those where they must begin; the links are then cut.
    """
    surplus = _surplus(counts)
    begins = sorted(t for t, v in surplus.items() for _ in range(max(v, 0)))
    ends = sorted(t for t, v in surplus.items() for _ in range(max(-v, 0)))
    out_edges: dict[str, list[tuple[str, bool]]] = {}
    for (before, after), count in sorted(counts.items()):
        out_edges.setdefault(before, []).extend([(after, False)] * count)
    for end, begin in zip(ends, begins, strict=True):
        out_edges.setdefault(end, []).append((begin, True))
    for edges in out_edges.values():
        order = rng.permutation(len(edges))
        edges[:] = [edges[i] for i in order]
    circuit = _circuit(out_edges, begins[0] if begins else min(out_edges))
    pieces = _cut(circuit, closed=not begins)
    return _shortened(pieces, number, most)


def _circuit(out_edges: dict[str, list[tuple[str, bool]]], start: str) -> list[tuple[str, bool]]:
    """Return the vertices of an Eulerian circuit with whether the step to each is a link."""
    stack: list[tuple[str, bool]] = [(start, True)]
    circuit: list[tuple[str, bool]] = []
    while stack:
        vertex = stack[-1][0]
        if out_edges.get(vertex):
            stack.append(out_edges[vertex].pop())
        else:
            circuit.append(stack.pop())
    return circuit[::-1]


def _cut(circuit: list[tuple[str, bool]], closed: bool) -> list[list[str]]:
    if closed:
        return [[vertex for vertex, _ in circuit]]
    # Turn the circuit so that it starts behind a link; then every link begins a new chain.
    steps = circuit[1:]
    first = next(i for i, (_, link) in enumerate(steps) if link)
    turned = steps[first:] + steps[:first]
    pieces: list[list[str]] = []
    for vertex, link in turned:
        if link:
            pieces.append([vertex])
        else:
            pieces[-1].append(vertex)
    return pieces


def _shortened(pieces: list[list[str]], number: int, most: int) -> list[list[str]]:
    """Cut the longest chains in two until there are enough, and none is too long."""
    pieces = [piece for piece in pieces if len(piece) > 1]
    while len(pieces) < number or max(len(piece) for piece in pieces) - 1 > most:
        longest = max(range(len(pieces)), key=lambda i: len(pieces[i]))
        piece = pieces.pop(longest)
        middle = len(piece) // 2
        if middle == 0 or len(piece) < 3:
            pieces.insert(longest, piece)
            break
        pieces[longest:longest] = [piece[: middle + 1], piece[middle:]]
    return pieces
