"""Curvature of a path from three points (Endres et al. 2013, section 2.2; Calabi et al. 1998).

The curvature at a sample is that of the circle through it and its two neighbours, four times
the triangle's area over the product of its sides. It does not change when the path is moved,
turned, mirrored or run backwards, whatever the speed, and is exact on circles.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.masked import unmasked


def curvature(
    path: NDArray[np.float64], spacing: int = 1, least_chord: float = 0.0
) -> NDArray[np.float64]:
    """Return the Euclidean curvature at each sample: (F, L) -> (F,), one over the path's unit.

    path: (F, L) positions, L = 2 or 3; NaN in gaps. spacing: the neighbours are this many
    samples before and after. least_chord: least distance to either neighbour, in the path's
    unit, for the three points to tell a curvature.

    NaN where there are none: at the first and last `spacing` samples, where one of the three
    is a gap, where two of them coincide, or where a neighbour is nearer than `least_chord`.
    A straight line has exactly or nearly 0, never NaN.

    Noise of SD e in each coordinate moves the curvature by about sqrt(6) e / c^2 with chords
    of length c: at low speed, where chords are short, it is noise. Low-pass first, and then
    take a wider `spacing` or a `least_chord`; both flatten bends sharper than the chord.
    On a path that comes back on itself the three points tell half a turn or nothing (0 on an
    exact reversal): sample it densely.
    """
    path = unmasked(path)
    if path.ndim != 2 or path.shape[1] not in (2, 3):
        raise SignkinError(
            f"the path has the shape {path.shape}", place="curvature", expected="(F, 2) or (F, 3)"
        )
    if spacing < 1:
        raise SignkinError(
            f"a spacing of {spacing}",
            place="curvature",
            expected="a whole number of samples from 1",
        )
    out = np.full(len(path), np.nan)
    if len(path) < 2 * spacing + 1:
        return out
    before = path[spacing:-spacing] - path[: -2 * spacing]
    after = path[2 * spacing :] - path[spacing:-spacing]
    a, b = np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)
    c = np.linalg.norm(before + after, axis=1)
    if path.shape[1] == 2:
        twice_area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    else:
        twice_area = np.linalg.norm(np.cross(before, after), axis=1)
    there = (np.minimum(a, b) > 0) & (np.minimum(a, b) >= least_chord) & (c > 0)
    middle = out[spacing:-spacing]
    middle[there] = 2 * twice_area[there] / (a[there] * b[there] * c[there])
    return out
