"""Fits against curve_fit, warped time against quadrature, and ground truth on recorded wrists."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import CubicSpline, make_interp_spline
from scipy.optimize import curve_fit
from scipy.spatial import KDTree

from signkin.corpus import load_corpus
from signkin.kinematics import curvature, lowpass, speed
from signkin.powerlaw import (
    GroundTruth,
    LeftOut,
    WarpSettings,
    fit_power_law,
    warp_to_power_law,
)
from signkin.stages.ingest import ingest
from support.signs import minimum_jerk_sign


@pytest.mark.parametrize("seed", range(8))
def test_fits_against_curve_fit(seed):
    rng = np.random.default_rng(seed)
    k = np.exp(rng.normal(2, 1.5, 120))
    alpha, beta = np.exp(rng.normal(0, 2)), rng.uniform(-1, 0)
    v = np.abs(alpha * k**beta * (1 + rng.normal(0, 0.2, 120)))
    told, _ = curve_fit(
        lambda x, a, b: a * x**b, k, v, p0=(alpha, beta), xtol=1e-12, ftol=1e-12, maxfev=10000
    )
    found = fit_power_law(v, k)
    assert (found.alpha, found.beta) == pytest.approx(told, rel=1e-5)


# --- a path known in closed form


def spiral(t):
    return np.column_stack([0.3 * np.cos(4 * t), 0.1 * np.sin(4 * t), 0.1 * np.sin(2.7 * t)])


def spiral_speed(t):
    return np.linalg.norm([-1.2 * np.sin(4 * t), 0.4 * np.cos(4 * t), 0.27 * np.cos(2.7 * t)])


def spiral_curvature(t):
    first = [-1.2 * np.sin(4 * t), 0.4 * np.cos(4 * t), 0.27 * np.cos(2.7 * t)]
    second = [-4.8 * np.cos(4 * t), -1.6 * np.sin(4 * t), -0.729 * np.sin(2.7 * t)]
    return np.linalg.norm(np.cross(first, second)) / np.linalg.norm(first) ** 3


@pytest.fixture(scope="module")
def warped():
    t = np.arange(481) / 240
    found = warp_to_power_law(spiral(t), 240.0, 4, WarpSettings(active_share=0.0))
    assert isinstance(found, GroundTruth)
    return found


def test_durations_and_gains_against_adaptive_quadrature(warped):
    """d tau / dt = v kappa^-beta / alpha, over the drawn intervals of recorded time."""
    edges = [0, *warped.boundaries_recorded_s, 2.0]
    for i, law in enumerate(warped.drawn):
        told, _ = quad(
            lambda t, law=law: spiral_speed(t) * spiral_curvature(t) ** -law.beta / law.alpha,
            edges[i], edges[i + 1], epsabs=1e-10, limit=200,
        )  # fmt: skip
        assert warped.durations_s[i] == pytest.approx(told, abs=2e-5)
    for i, at in enumerate(warped.boundaries_recorded_s):
        before, after = (warped.drawn[j].speed(spiral_curvature(at)) for j in (i, i + 1))
        assert before == pytest.approx(float(after), rel=1e-6)
    assert warped.duration_s == pytest.approx(2.0, abs=1e-9)


def test_positions_against_an_integrated_differential_equation(warped):
    """dt / d tau = alpha kappa^beta / v, solved forwards by Runge-Kutta, segment by segment."""
    edges = [0, *warped.boundaries_recorded_s, 2.0]
    for i, law in enumerate(warped.drawn):
        start = float(warped.durations_s[:i].sum())
        here = warped.segment == i
        solved = solve_ivp(
            lambda _, t, law=law: law.speed(spiral_curvature(t[0])) / spiral_speed(t[0]),
            (start, start + warped.durations_s[i]), [edges[i]], t_eval=warped.time_s[here],
            rtol=1e-9, atol=1e-9,
        )  # fmt: skip
        assert warped.positions[here] == pytest.approx(spiral(solved.y[0]), abs=1e-4)


# --- the path stays


def farthest(samples, curve, last_s):
    """Return the largest distance of samples to a curve."""
    return KDTree(curve(np.linspace(0, last_s, 100_000))).query(samples)[0].max()


def test_the_path_is_the_recorded_one_to_a_tenth_of_a_millimetre():
    """To a cubic spline through the recorded samples, which had no part in the warping."""
    signs = [minimum_jerk_sign(np.random.default_rng(seed)) for seed in range(6)]
    found = [warp_to_power_law(sign, 240.0, seed) for seed, sign in enumerate(signs)]
    warps = [
        (s[t.active], t) for s, t in zip(signs, found, strict=True) if not isinstance(t, LeftOut)
    ]
    assert len(warps) >= 4
    for recorded, truth in warps:
        frames = np.arange(len(recorded)) / 240
        curve = CubicSpline(frames, recorded)
        assert farthest(truth.positions, curve, frames[-1]) < 1e-4
        # and all of it, from end to end, no faster than told
        assert truth.positions[0] == pytest.approx(recorded[0], abs=1e-4)
        rest = np.linalg.norm(truth.positions[-1] - recorded[-1])
        assert rest < truth.top_speeds[-1] / 240
        steps = np.linalg.norm(np.diff(truth.positions, axis=0), axis=1)
        assert steps.max() <= truth.top_speeds.max() / 240 * 1.001


@pytest.mark.parametrize(("name", "most_left_out"), [("dgs-1984189", 0.2), ("libras", 0.7)])
def test_recorded_wrists(root, real_corpora, name, most_left_out):
    corpus = load_corpus(root / "corpora" / name)
    take = ingest(corpus, real_corpora / name, corpus.entries[:1]).recordings[0]
    wrist = lowpass(take.track("right_wrist"), take.rate_hz, 6.0, method="fir")
    pieces = np.array_split(wrist, int(len(wrist) / take.rate_hz / 2))
    found = [warp_to_power_law(piece, take.rate_hz, i) for i, piece in enumerate(pieces)]
    assert np.mean([isinstance(one, LeftOut) for one in found]) <= most_left_out
    for piece, truth in zip(pieces, found, strict=True):
        if isinstance(truth, LeftOut):
            assert truth.reason
            continue
        k = curvature(truth.positions)
        v = speed(truth.positions, truth.rate_hz)
        for i in range(3):
            here = (truth.segment == i) & np.isfinite(k)
            assert fit_power_law(v[here], k[here]).r_squared > 0.97
        recorded = piece[truth.active]
        frames = np.arange(len(recorded)) / take.rate_hz
        curve = make_interp_spline(frames, recorded, k=5)
        assert farthest(truth.positions, curve, frames[-1]) < 1e-4
