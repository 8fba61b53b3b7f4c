"""Signs made of overlapping minimum-jerk strokes: paths for tests, no evidence about people."""

import numpy as np

from signkin.kinematics import lowpass


def minimum_jerk_sign(
    rng: np.random.Generator, seconds: float = 1.5, rate_hz: float = 240.0, noise_sd: float = 0.0008
) -> np.ndarray:
    """Return the wrist's path of a sign, (F, 3), m, low-passed as in Endres et al. 2013, 2.2."""
    t = np.arange(round(seconds * rate_hz)) / rate_hz
    path = np.zeros((len(t), 3))
    for start in np.linspace(0, seconds - 0.5, 5) + rng.uniform(-0.05, 0.05, 5):
        u = np.clip((t - start) / rng.uniform(0.4, 0.6), 0, 1)
        path += (10 * u**3 - 15 * u**4 + 6 * u**5)[:, None] * rng.normal(0, 0.12, 3)
    path += rng.normal(0, noise_sd, path.shape)
    return lowpass(path, rate_hz, 6.0, method="fir")
