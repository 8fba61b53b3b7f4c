"""Compile the kernels once, ahead of jobs that would each do it at the same time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from signkin import jit
from signkin.binning import segments
from signkin.binning.fitting import EVERY_COUNT_UP_TO, fit, log_evidence
from signkin.binning.hit_rate import chance_line, hit_rate, match
from signkin.binning.prior import Prior
from signkin.binning.shifted import shifted_hits
from signkin.binning.stale import forget_stale

# The files with compiled functions, each of which may take in code of the others.
KERNELS = (
    "band",
    "best_path",
    "counts",
    "evidence_alone",
    "evidence_layout",
    "exact",
    "lanes",
    "lanes_llvm",
    "lanes_numpy",
    "log_domain",
    "maxima",
    "pairs",
    "prices",
    "segmentation",
    "segments",
    "sum_product",
)


def forget_stale_kernels() -> bool:
    """Forget all machine code that numba has kept, if a source of it has changed since.

    To be called before jobs that use the kernels: numba itself would go on with old code (see
    stale.py). Returns whether there was something to forget.
    """
    if jit.JIT_OFF:
        return False
    dispatcher: Any = segments.segment_evidence
    folder = Path(str(dispatcher.stats.cache_path))
    sources = [Path(__file__).with_name(f"{name}.py") for name in KERNELS]
    return forget_stale(folder, [*sources, Path(jit.__file__)])


def compile_kernels() -> None:
    """Run every compiled function on small data; numba keeps the code beside the sources.

    Takes some 25 s the first time, and again when the code or numba has changed; else nothing.
    What was kept of other sources is forgotten first.
    """
    forget_stale_kernels()
    rng = np.random.default_rng(0)
    prior = Prior(noise_sd=1.0)
    for bins, longest in ((12, None), (EVERY_COUNT_UP_TO + 1, None), (EVERY_COUNT_UP_TO + 1, 20)):
        x = rng.normal(size=(bins, 2))
        for far in (0.0, 1e9):  # with 16 digits, and with 32
            found = fit(x + far, (0, 1), prior, max_segment_bins=longest)
            found.map_trajectory(1)
            found.boundaries(1)
    log_evidence(rng.normal(size=(12, 2)), (0, 1), prior)
    fit(rng.normal(size=(EVERY_COUNT_UP_TO + 1, 2)), (0,), prior, max_segment_bins=9, whole_up_to=1)
    match([0.1], [0.1])
    hit_rate([0.1], [0.1], duration_s=1.0)
    shifted_hits([0.1], [0.1], 0.1, duration_s=1.0)
    chance_line([[0.5]], [1.0], 0, [1.0], draws=1)
