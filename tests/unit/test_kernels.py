"""Kernels on data so small that each segmentation can be looked at; the JIT may be off."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.special import logsumexp

from signkin.binning import compiled, fit, fitting, segment_log_evidence, segments
from signkin.binning.compiled import KERNELS, forget_stale_kernels
from signkin.binning.log_domain import log_ways
from signkin.binning.segmentation import best_boundaries, log_compositions
from signkin.binning.stale import STAMP
from signkin.jit import JIT_OFF
from support.binning_model import Model, enumerate_all, segmentations
from support.small_fits import BAND, CASES, PRIOR, walk


@pytest.mark.parametrize("case", CASES)
def test_a_fit_is_the_sum_over_all_segmentations(case):
    bins, dims, orders, options = CASES[case]
    bins = min(bins, 8 + max(orders) // 4)
    x = walk(bins, dims, bins)
    if bins <= max(orders):
        orders = (orders[0],)
    found = fit(x, orders, PRIOR, **options)
    model = Model(np.diag(np.full(dims, dims * 0.25)), float(dims), 0.1, 1.0)
    for i, order in enumerate(orders):
        slow = enumerate_all(x, order, model, options.get("max_segment_bins"))
        counts = found.log_evidence_by_count[i]
        np.testing.assert_allclose(counts, slow.log_evidence_by_count[: len(counts)], atol=1e-9)
        if "max_count" in options:
            continue
        assert found.log_evidence[i] == pytest.approx(slow.log_evidence, abs=1e-9)
        assert found.boundary_probability(order) == pytest.approx(slow.boundary, abs=1e-10)
        assert found.expected_trajectory(order) == pytest.approx(slow.mean, abs=1e-8)
        assert found.noise_covariance(order) == pytest.approx(slow.noise, rel=1e-8, abs=1e-10)


def test_the_band_is_every_count_where_it_is_wide(monkeypatch):
    bins, dims, orders, options = BAND
    x = walk(bins, dims, 3)
    every = fit(x, orders, PRIOR, **options)
    monkeypatch.setattr(fitting, "EVERY_COUNT_UP_TO", 0)
    band = fit(x, orders, PRIOR, **options)
    assert band.log_evidence == pytest.approx(every.log_evidence, abs=1e-9)
    assert (band.cut_mass < 1e-4).all()
    for order in orders:
        for what in ("boundary_probability", "expected_trajectory", "count_probability"):
            values = [getattr(posterior, what)(order) for posterior in (band, every)]
            assert values[0] == pytest.approx(values[1], abs=1e-9)


@pytest.mark.parametrize("longest", [6, 3])
def test_sums_and_the_best_cut_are_those_of_a_list_of_all(longest):
    bins = 6
    evidence = np.random.default_rng(longest).normal(size=(bins, longest, 8)) * 20
    table = np.empty((bins + 1, bins + 4, 8))
    log_ways(evidence, bins, table)
    number = log_compositions(bins, longest, bins)
    for count in range(bins):
        cuts = list(segmentations(bins, count, longest))
        if not cuts:
            assert np.isneginf(table[0, count + 1]).all() and np.isneginf(number[count])
            continue
        sums = np.array([[sum(evidence[a, b - a, i] for a, b in cut) for cut in cuts]
                         for i in range(8)])  # fmt: skip
        assert table[0, count + 1] == pytest.approx(logsumexp(sums, axis=1), abs=1e-11)
        assert number[count] == pytest.approx(math.log(len(cuts)), abs=1e-12)
        best = cuts[int(np.argmax(sums[0]))]
        found = best_boundaries(np.ascontiguousarray(evidence[..., 0]), count + 1)
        assert found.tolist() == [b for _, b in best[:-1]]


def test_segments_in_both_layouts_are_the_same():
    x = walk(12, 3, 5)
    evidence = segment_log_evidence(x, 2, PRIOR)
    assert fit(x, (2,), PRIOR).log_evidence_by_count[0, 0] == evidence[0, -1]


def test_all_files_with_kernels_are_known_to_be(root):
    folder = root / "src" / "signkin" / "binning"
    marks = ("@kernel", "@helper", "@inlined", "helper(", "from numba")
    holding = {f.stem for f in folder.glob("*.py") if any(m in f.read_text() for m in marks)}
    assert set(KERNELS) - {"lanes_numpy"} == holding - {"stale", "compiled"}


def test_forgetting_looks_at_all_files_with_kernels(monkeypatch):
    asked = []
    monkeypatch.setattr(compiled, "forget_stale", lambda *told: bool(asked.append(told)) or True)
    assert forget_stale_kernels() is not JIT_OFF
    for folder, files in asked:
        assert folder.name  # where numba keeps its code, which need not be there yet
        assert all(file.is_file() for file in files)
        assert len(files) == len(KERNELS) + 1  # and how they are compiled
    assert bool(asked) is not JIT_OFF


@pytest.mark.parametrize("asked", [False, True])
def test_kernels_are_forgotten_when_asked_and_not_by_an_import(root, tmp_path, asked):
    environment = {**os.environ, "PYTHONPATH": str(root / "src"), "NUMBA_CACHE_DIR": str(tmp_path)}
    code = "from signkin.binning import compiled" + "; compiled.forget_stale_kernels()" * asked
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
    assert bool(list(tmp_path.rglob(STAMP))) is (asked and not JIT_OFF)


def test_the_jit_is_on_or_off_as_asked():
    assert hasattr(segments.segment_evidence, "py_func") is not JIT_OFF
