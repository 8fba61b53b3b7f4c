"""Results of every kernel on small data; run as a script, it writes them to a file.

Sizes are small: with the JIT off a fit of 100 bins takes minutes.
"""

import sys

import numpy as np

from signkin.binning import Prior, chance_line, fit, fitting, match
from signkin.binning.log_domain import log_posterior, log_ways

PRIOR = Prior(noise_sd=0.5)
FIELDS = (
    "log_evidence_by_count", "log_evidence", "order_probability", "cut_mass",
    "_count_probability", "_boundary", "_mean", "_noise",
)  # fmt: skip
CASES = {
    "three dimensions": (14, 3, (0, 3), {}),
    "two dimensions": (11, 2, (1, 9), {}),
    "one dimension": (9, 1, (0, 1, 2), {"max_segment_bins": 4}),
    "few counts": (13, 3, (0, 2), {"max_count": 2}),
    "five dimensions": (8, 5, (2,), {}),
}
BAND = (18, 2, (0, 1), {"max_segment_bins": 9})


def walk(bins, dims, seed, size=1.0):
    x = np.random.default_rng(seed).normal(size=(bins, dims)).cumsum(0) * size
    return x - x.mean(0)


def _of_a_fit(name, bins, dims, orders, options):
    found = fit(walk(bins, dims, bins), orders, PRIOR, **options)
    out = {f"{name}: {field}": getattr(found, field) for field in FIELDS}
    out[f"{name}: map"] = found.map_trajectory(orders[-1], 3)
    return out


def results() -> dict[str, np.ndarray]:
    """Return arrays by what they are."""
    out = {}
    for name, case in CASES.items():
        out |= _of_a_fit(name, *case)
    for size in (1e4, 1e9):  # residuals on a line, and more digits than sixteen
        x = walk(10, 3, 1) + size * np.linspace(-1, 1, 10)[:, None]
        found = fit(x, (0, 2), PRIOR)
        out |= {f"a stroke of {size:g}: {field}": getattr(found, field) for field in FIELDS}
    every, fitting.EVERY_COUNT_UP_TO = fitting.EVERY_COUNT_UP_TO, 0
    try:
        out |= _of_a_fit("band", *BAND)
    finally:
        fitting.EVERY_COUNT_UP_TO = every
    rng = np.random.default_rng(3)
    evidence = rng.normal(size=(7, 5, 8)) * 30
    table, mass = np.empty((8, 4 + 4, 8)), rng.dirichlet(np.ones(4), 8).T.copy()
    log_ways(evidence, 4, table)
    boundary, segments = np.zeros((7, 8)), np.zeros((7, 5, 8))
    log_posterior(evidence, mass, boundary, segments)
    out |= {"log domain: sums": table, "log domain: boundary": boundary}
    out["log domain: segments"] = segments
    pairs = match(np.sort(rng.uniform(0, 2, 9)), np.sort(rng.uniform(0, 2, 7)))
    out |= {"pairs: predicted": pairs[0], "pairs: truth": pairs[1]}
    out["chance"] = chance_line([[0.5, 1.0], [0.3]], [1.5, 1.0], 4, [1.0, 5.0], draws=5).hit_rate
    return out


if __name__ == "__main__":
    np.savez(sys.argv[1], **results())
