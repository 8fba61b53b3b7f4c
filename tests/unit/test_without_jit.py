"""Kernels do the same as plain Python: their tests pass with the JIT off, and results agree."""

import os
import subprocess
import sys

import numpy as np
import pytest

from signkin.jit import JIT_OFF
from support import small_fits

pytestmark = pytest.mark.skipif(JIT_OFF, reason="this is the run with the JIT off")

BOTH_WAYS = ("test_lanes.py", "test_kernels.py", "test_hit_rate.py")


def without_jit(root, *arguments):
    path = os.pathsep.join([str(root / "src"), str(root / "tests")])
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=root,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_tests_of_kernels_pass_without_the_jit(root):
    files = [str(root / "tests" / "unit" / name) for name in BOTH_WAYS]
    done = without_jit(root, "-m", "pytest", "-q", "-p", "no:cacheprovider", *files)
    assert done.returncode == 0, done.stdout[-3000:]
    assert "passed" in done.stdout and "skipped" not in done.stdout


def test_results_agree_with_those_of_compiled_kernels(root, tmp_path):
    file = tmp_path / "results.npz"
    done = without_jit(root, str(root / "tests" / "support" / "small_fits.py"), str(file))
    assert done.returncode == 0, done.stderr[-3000:]
    compiled = small_fits.results()
    with np.load(file) as plain:
        assert set(plain.files) == set(compiled)
        for name, values in compiled.items():
            np.testing.assert_allclose(plain[name], values, rtol=1e-12, atol=1e-13, err_msg=name)
