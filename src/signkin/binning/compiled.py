"""Compile the kernels once, ahead of jobs that would each do it at the same time."""

from __future__ import annotations

import numpy as np

from signkin.binning.hit_rate import chance_line, match
from signkin.binning.posterior import EVERY_COUNT_UP_TO, fit
from signkin.binning.prior import Prior


def compile_kernels() -> None:
    """Run every compiled function on small data; numba keeps the code beside the sources.

    Takes some 25 s the first time, and again when the code or numba has changed; else nothing.
    """
    rng = np.random.default_rng(0)
    prior = Prior(noise_sd=1.0)
    for bins, longest in ((12, None), (EVERY_COUNT_UP_TO + 1, None), (EVERY_COUNT_UP_TO + 1, 20)):
        x = rng.normal(size=(bins, 2))
        fit(x, (0, 1), prior, max_segment_bins=longest).map_trajectory(1)
    match([0.1], [0.1])
    chance_line([[0.5]], [1.0], 0, [1.0], draws=1)
