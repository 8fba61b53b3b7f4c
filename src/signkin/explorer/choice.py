"""Which recordings of a corpus get a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np


def chosen(names: Sequence[str], troubles: Mapping[str, float], most: int | None) -> list[str]:
    """Return at most so many of a corpus's recordings, in their order; None: all.

    Half of them are those that most need a look (troubles: recording -> how much), the others are
    spread evenly over the rest of the corpus: not fifty of one sign.
    """
    if most is None or len(names) <= most:
        return list(names)
    place = {name: i for i, name in enumerate(names)}
    troubled = [name for name in names if troubles.get(name, 0)]
    worst = sorted(troubled, key=lambda name: (-troubles[name], place[name]))[: most // 2]
    rest = [name for name in names if name not in set(worst)]
    wanted = most - len(worst)
    spread = [rest[i] for i in np.linspace(0, len(rest) - 1, wanted).round().astype(int)]
    return sorted({*worst, *spread}, key=lambda name: place[name])
