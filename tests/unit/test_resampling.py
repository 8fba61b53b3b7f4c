import numpy as np
import pytest

from signkin import resampling


def test_weights_drawn_some_at_a_time_are_those_drawn_as_one(monkeypatch):
    rng = np.random.default_rng(5)
    a, b = rng.normal(0.1, 1, (2, 400))
    clusters = {"unit": list(range(400))}
    whole = resampling.difference(a, b, clusters, 501, np.random.default_rng(1))
    monkeypatch.setattr(resampling, "WHOLE_UP_TO", 0)
    monkeypatch.setattr(resampling, "AT_ONCE", 3000)
    parts = resampling.difference(a, b, clusters, 501, np.random.default_rng(1))
    assert (parts.low, parts.high) == pytest.approx((whole.low, whole.high), rel=1e-12)
