"""Evidence of all segments and expectations over them: the kernels, with memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning import segments
from signkin.binning.exact import segment_evidence_exactly
from signkin.binning.lanes import WIDTH
from signkin.binning.prior import Prior, exact_rotations, tables
from signkin.binning.room import Room
from signkin.errors import SignkinError

Floats = NDArray[np.float64]

ROOM = Room()
# In units of the prior's noise. Above, a residual of one noise SD is not told from rounding to the
# ten digits that evidences have, and the kernels with 32 digits take over; above the second, those
# have not enough either.
EXACT_ABOVE = 1e5
MOST_NOISES = 1e20


class Engine:
    """The kernels for one trajectory (T, L) and the orders 0 to n_orders - 1.

    exact: whether the data are so large that numbers want 32 digits. Smaller ones may have
    residuals on a line, which the ordinary kernel tells, and then takes more care.
    """

    def __init__(
        self, x: Floats, prior: Prior, longest: int, n_orders: int, dt_s: float | None
    ) -> None:
        self.bins, self.dims = x.shape
        self.longest = longest
        self.n_orders = n_orders
        self._x = x
        self._scale = prior.inverse_scale(self.dims)
        self._made = tables(prior, self.bins, longest, self.dims, n_orders, dt_s)
        self._exact_key = (longest, n_orders, prior.concentration, prior.step(self.bins, dt_s))
        self._whitened = self._rows(x / np.sqrt(self._scale))
        size = np.abs(self._whitened).max()
        if not size < MOST_NOISES:
            raise SignkinError(
                f"positions up to {size:.1e} times the prior's noise",
                expected=f"less than {MOST_NOISES:.0e}",
                todo="Check the unit of the data against that of noise_sd.",
            )
        self.exact = bool(size > EXACT_ABOVE)

    def _rows(self, x: Floats) -> Floats:
        """Return data as the kernels want them, (L, T + 8): a row for each dimension."""
        out = np.zeros((self.dims, self.bins + WIDTH))
        out[:, : self.bins] = x.T
        return out

    def by_segment(self) -> Floats:
        """Return the log evidence of all segments, (G, T, W, 8)."""
        groups = -(-self.n_orders // WIDTH)
        return self._filled(ROOM.array("evidence", groups, self.bins, self.longest, WIDTH))

    def by_order(self) -> Floats:
        """Return the log evidence of all segments, (D, T, W)."""
        return self._filled(ROOM.array("evidence", self.n_orders, self.bins, self.longest))

    def _filled(self, out: Floats) -> Floats:
        made = self._made
        if self.exact:
            rotations = exact_rotations(*self._exact_key)
            segment_evidence_exactly(
                self._rows(self._x), rotations, made.constant, made.half, self._scale, self.bins,
                out,
            )  # fmt: skip
            return out
        given = (self._whitened, made.cosine, made.sine, made.constant, made.half, self.bins)
        if segments.segment_evidence(*given, False, out):
            segments.segment_evidence(*given, True, out)
        return out

    def expect(self, probability: Floats, wanted: tuple[int, ...]) -> tuple[Floats, Floats]:
        """Return the wanted orders' expected trajectories and noise, in the data's unit.

        probability: of segments, by segment or by order.
        """
        orders, dims, made = self.n_orders, self.dims, self._made
        asked = np.zeros(orders, dtype=np.int64)
        asked[list(wanted)] = 1
        longest = probability.shape[2]
        z = ROOM.array("z", longest + 1, orders, dims, WIDTH)
        chances = ROOM.array("chances", longest, -(-orders // WIDTH) * WIDTH, WIDTH)
        mean = np.empty((orders, dims, self._whitened.shape[1]))
        noise = np.empty((orders, dims, dims))
        if self.exact:
            x, scale, unit = self._rows(self._x), self._scale, np.ones(dims)
            rotations = exact_rotations(*self._exact_key)
            z_low = ROOM.array("z_low", *z.shape)
        else:
            x, scale, unit = self._whitened, np.ones(dims), np.sqrt(self._scale)
            rotations, z_low = np.empty((4, 0, 0)), np.empty((0, orders, dims, WIDTH))
        segments.expectations(
            x, made.cosine, made.sine, made.inverse, made.powers, made.half, self.bins,
            probability, asked, mean, noise, z, chances, scale, rotations, z_low,
        )  # fmt: skip
        rows = list(wanted)
        means = np.ascontiguousarray(mean[rows, :, : self.bins].transpose(0, 2, 1))
        return means * unit, noise[rows] * (unit[:, None] * unit)
