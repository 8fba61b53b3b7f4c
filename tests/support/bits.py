"""Every number of some fits as one digest; run as a script, it prints it."""

import hashlib

import numpy as np

from signkin.binning import Prior, fit
from signkin.binning.compiled import forget_stale_kernels


def digest() -> str:
    """Return the digest of fits in three and in two dimensions, short and with a band."""
    rng = np.random.default_rng(7)
    found = hashlib.sha256()
    for bins, dims, options in ((60, 3, {}), (60, 2, {"max_count": 9}), (270, 3, {})):
        x = np.cumsum(rng.normal(size=(bins, dims)), axis=0)
        posterior = fit(x - x.mean(axis=0), (0, 3, 7), Prior(noise_sd=0.5), **options)
        numbers = [posterior.log_evidence_by_count, posterior.log_evidence, posterior.cut_mass]
        for order in posterior.orders:
            numbers += [
                posterior.count_probability(order),
                posterior.boundary_probability(order),
                posterior.expected_trajectory(order),
                posterior.noise_covariance(order),
            ]
        for values in numbers:
            found.update(np.ascontiguousarray(values).tobytes())
    return found.hexdigest()


if __name__ == "__main__":
    forget_stale_kernels()
    print(digest())
