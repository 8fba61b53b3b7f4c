"""Compiled: the evidence of segments with 32 digits, for data that are huge beside their noise.

Where residuals are large and nearly on a line, what lies beside the line is lost from their
squares and products; at 1e8 noise SDs, from the residuals themselves. Here each number is a sum
of two (double-double: Dekker 1971; Hida, Li & Bailey 2001), the data are taken in their own
unit, exactly as given, and V^-1 + R is kept as L D L' which each residual updates (Gill, Golub,
Murray & Saunders 1974, method C1): nothing is subtracted from its diagonal.

Some twenty times slower than segments.py; names and arrays as there. An array's second half is
in another of the same shape, called _low.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.binning.evidence_layout import write_evidence
from signkin.binning.lanes import WIDTH, aligned, load, log, splat, store
from signkin.jit import inlined, kernel

F = NDArray[np.float64]

SPLITTER = 134217729.0  # 2**27 + 1: leaves the upper half of a number's digits


@inlined
def _quick_sum(a: Any, b: Any) -> Any:
    """Return a + b and what is lost in it, for a the larger."""
    s = a + b
    return s, b - (s - a)


@inlined
def _two_sum(a: Any, b: Any) -> Any:
    s = a + b
    v = s - a
    return s, (a - (s - v)) + (b - v)


@inlined
def _two_product(a: Any, b: Any) -> Any:
    p = a * b
    t = a * SPLITTER
    a_high = t - (t - a)
    a_low = a - a_high
    t = b * SPLITTER
    b_high = t - (t - b)
    b_low = b - b_high
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


@inlined
def _add(a: Any, a_low: Any, b: Any, b_low: Any) -> Any:
    s, e = _two_sum(a, b)
    t, f = _two_sum(a_low, b_low)
    s, e = _quick_sum(s, e + t)
    return _quick_sum(s, e + f)


@inlined
def _multiply(a: Any, a_low: Any, b: Any, b_low: Any) -> Any:
    p, e = _two_product(a, b)
    return _quick_sum(p, e + (a * b_low + a_low * b))


@inlined
def _divide(a: Any, a_low: Any, b: Any, b_low: Any) -> Any:
    zero = splat(0.0)
    first = a / b
    p, p_low = _multiply(first, zero, b, b_low)
    r, r_low = _add(a, a_low, zero - p, zero - p_low)
    second = r / b
    p, p_low = _multiply(second, zero, b, b_low)
    r, r_low = _add(r, r_low, zero - p, zero - p_low)
    q, q_low = _quick_sum(first, second)
    return _add(q, q_low, r / b, zero)


@inlined
def append_exactly(
    x: F, at: int, rotations: F, n: int, d: int, z: F, z_low: F, old: int, new: int,
    rest: F, rest_low: F,
) -> None:  # fmt: skip
    """Rotate bin at, at + 1, .. at + 7 into z, for order d; for lower orders it has been done.

    rotations: (4, N, D), cosines and sines, and the second halves of both. rest: (L, 8), what
    lower orders left of the data, becomes the residual of order d.
    """
    c, s = rotations[0, n, d], rotations[1, n, d]
    c_low, s_low = rotations[2, n, d], rotations[3, n, d]
    for k in range(x.shape[0]):
        if d == 0:
            e, e_low = load(x, (k, at)), splat(0.0)
        else:
            e, e_low = load(rest, (k, 0)), load(rest_low, (k, 0))
        y, y_low = load(z, (old, d, k, 0)), load(z_low, (old, d, k, 0))
        a, a_low = _multiply(y, y_low, c, c_low)
        b, b_low = _multiply(e, e_low, s, s_low)
        a, a_low = _add(a, a_low, b, b_low)
        store(z, (new, d, k, 0), a)
        store(z_low, (new, d, k, 0), a_low)
        a, a_low = _multiply(e, e_low, c, c_low)
        b, b_low = _multiply(y, y_low, -s, -s_low)
        a, a_low = _add(a, a_low, b, b_low)
        store(rest, (k, 0), a)
        store(rest_low, (k, 0), a_low)


@inlined
def _update(factor: F, factor_low: F, d: int, rest: F, rest_low: F, w: F, w_low: F) -> None:
    """Add a residual's squares and products to the factors L and D of order d.

    factor: (D, L (L+1)/2, 8), row by row, the diagonal of D in the place of L's, which is 1.
    w: (L, 8) scratch.
    """
    dims = rest.shape[0]
    zero = splat(0.0)
    for k in range(dims):
        store(w, (k, 0), load(rest, (k, 0)))
        store(w_low, (k, 0), load(rest_low, (k, 0)))
    a, a_low = splat(1.0), zero
    for k in range(dims):
        at = k * (k + 3) // 2
        p, p_low = load(w, (k, 0)), load(w_low, (k, 0))
        old, old_low = load(factor, (d, at, 0)), load(factor_low, (d, at, 0))
        b, b_low = _multiply(a, a_low, p, p_low)
        t, t_low = _multiply(b, b_low, p, p_low)
        new, new_low = _add(old, old_low, t, t_low)
        store(factor, (d, at, 0), new)
        store(factor_low, (d, at, 0), new_low)
        if k == dims - 1:
            break
        b, b_low = _divide(b, b_low, new, new_low)
        a, a_low = _multiply(a, a_low, old, old_low)
        a, a_low = _divide(a, a_low, new, new_low)
        for j in range(k + 1, dims):
            of = j * (j + 1) // 2 + k
            l, l_low = load(factor, (d, of, 0)), load(factor_low, (d, of, 0))  # noqa: E741
            t, t_low = _multiply(p, p_low, l, l_low)
            v, v_low = load(w, (j, 0)), load(w_low, (j, 0))
            v, v_low = _add(v, v_low, zero - t, zero - t_low)
            store(w, (j, 0), v)
            store(w_low, (j, 0), v_low)
            t, t_low = _multiply(b, b_low, v, v_low)
            l, l_low = _add(l, l_low, t, t_low)  # noqa: E741
            store(factor, (d, of, 0), l)
            store(factor_low, (d, of, 0), l_low)


@kernel
def segment_evidence_exactly(
    x: F, rotations: F, constant: F, half: F, scale: F, bins: int, out: F
) -> None:
    """Fill out as `segments.segment_evidence` does, of data in their own unit.

    x: (L, T + 8). scale: (L,) the diagonal of V^-1. rotations: as in `append_exactly`.
    """
    dims = x.shape[0]
    orders = constant.shape[1]
    groups = (orders - 1) // WIDTH + 1
    longest = out.shape[2]
    pairs = dims * (dims + 1) // 2
    z = aligned(2 * orders * dims * WIDTH).reshape((2, 1, orders, dims, WIDTH))
    factor = aligned(2 * orders * pairs * WIDTH).reshape((2, orders, pairs, WIDTH))
    rest = aligned(4 * dims * WIDTH).reshape((4, dims, WIDTH))
    values = aligned(groups * WIDTH * WIDTH).reshape((groups * WIDTH, WIDTH))
    turned = aligned(WIDTH * WIDTH).reshape((WIDTH, WIDTH))
    for first in range(0, bins, WIDTH):
        z[:] = 0.0
        factor[:] = 0.0
        for k in range(dims):
            factor[0, :, k * (k + 3) // 2] = scale[k]
        for n in range(min(longest, bins - first)):
            for d in range(orders):
                append_exactly(
                    x, first + n, rotations, n, d, z[0], z[1], 0, 0, rest[0], rest[1]
                )  # fmt: skip
                _update(factor[0], factor[1], d, rest[0], rest[1], rest[2], rest[3])
                value = splat(0.0)
                for k in range(dims):
                    pivot = load(factor, (0, d, k * (k + 3) // 2, 0))
                    small = load(factor, (1, d, k * (k + 3) // 2, 0)) / pivot
                    value = value + (log(pivot / scale[k]) + small)
                store(values, (d, 0), constant[n, d] - half[n] * value)
            write_evidence(values, turned, orders, first, n, bins, out)
