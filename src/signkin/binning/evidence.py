"""Evidence of all segments and expectations over them: the kernels of segments.py, with memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning import segments
from signkin.binning.lanes import WIDTH
from signkin.binning.prior import Prior, Tables
from signkin.binning.room import Room

Floats = NDArray[np.float64]

ROOM = Room()


def whitened_by(x: Floats, prior: Prior) -> Floats:
    """Return the data in units of the prior's noise, (L, T + 8): a row for each dimension."""
    bins, dims = x.shape
    out = np.zeros((dims, bins + WIDTH))
    out[:, :bins] = (x / np.sqrt(prior.inverse_scale(dims))).T
    return out


def by_segment(whitened: Floats, bins: int, made: Tables, longest: int) -> Floats:
    """Return the log evidence of all segments, (G, T, W, 8)."""
    groups = -(-made.cosine.shape[1] // WIDTH)
    return _filled(ROOM.array("evidence", groups, bins, longest, WIDTH), whitened, bins, made)


def by_order(whitened: Floats, bins: int, made: Tables, longest: int) -> Floats:
    """Return the log evidence of all segments, (D, T, W)."""
    orders = made.cosine.shape[1]
    return _filled(ROOM.array("evidence", orders, bins, longest), whitened, bins, made)


def _filled(out: Floats, whitened: Floats, bins: int, made: Tables) -> Floats:
    tables_of_evidence = (made.cosine, made.sine, made.constant, made.half)
    segments.segment_evidence(whitened, *tables_of_evidence, bins, out)
    return out


def expect(
    whitened: Floats, bins: int, made: Tables, probability: Floats, wanted: tuple[int, ...],
    inverse_scale: Floats,
) -> tuple[Floats, Floats]:  # fmt: skip
    """Return the wanted orders' expected trajectories and noise, in the data's unit."""
    orders = made.cosine.shape[1]
    dims = len(whitened)
    asked = np.zeros(orders, dtype=np.int64)
    asked[list(wanted)] = 1
    longest = probability.shape[2]
    z = ROOM.array("z", longest + 1, orders, dims, WIDTH)
    chances = ROOM.array("chances", longest, -(-orders // WIDTH) * WIDTH, WIDTH)
    mean = np.empty((orders, dims, whitened.shape[1]))
    noise = np.empty((orders, dims, dims))
    segments.expectations(
        whitened, made.cosine, made.sine, made.inverse, made.powers, made.half, bins,
        probability, asked, mean, noise, z, chances,
    )  # fmt: skip
    scale = np.sqrt(inverse_scale)
    rows = list(wanted)
    means = np.ascontiguousarray(mean[rows, :, :bins].transpose(0, 2, 1))
    return means * scale, noise[rows] * (scale[:, None] * scale)
