"""Fixtures that all layers share."""

from __future__ import annotations

import fcntl
import os
import shutil
from pathlib import Path

import hypothesis
import pytest

from signkin.binning.compiled import forget_stale_kernels
from support.runs import QUICK, Run, checked, prepare, run

ROOT = Path(__file__).resolve().parents[1]

# How long an example takes is the machine's business: a busy one, or coverage, is no failure.
hypothesis.settings.register_profile("signkin", deadline=None)
hypothesis.settings.load_profile("signkin")


# Whole runs go first: with several workers, the last of them would be waited for. One worker
# begins with the run that compiles the kernels of binning, the other with what wants none, or
# both would compile them. The longest stand next.
FIRST = (
    "test_synthesis", "test_slurm", "test_bad_input", "test_real", "test_what_cannot_be_made",
    "test_simulated", "test_adding_a_corpus", "test_endres", "test_audit", "test_real_signs",
)  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put whole runs first, in the order of FIRST."""
    items.sort(key=lambda item: _turn(item.path))


def _turn(module: Path) -> int:
    if "workflow" not in module.parts:
        return len(FIRST) + 1
    return FIRST.index(module.stem) if module.stem in FIRST else len(FIRST)


@pytest.fixture(scope="session", autouse=True)
def kernels_of_these_sources() -> None:
    """Forget machine code of older sources, which numba would go on with."""
    forget_stale_kernels()


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Folder of the real recordings; tests that want it are skipped without."""
    folder = os.environ.get("SIGNKIN_DATA")
    if not folder:
        pytest.skip("real recordings: SIGNKIN_DATA is not set")
    path = Path(folder)
    if not path.is_dir():
        pytest.fail(f"SIGNKIN_DATA is {folder}, which is no folder")
    return path.resolve()


@pytest.fixture(scope="session")
def real_corpora(real_data: Path) -> Path:
    """The data folder, where it holds the corpora that the project describes."""
    missing = [n for n in ("dgs-1984189", "boston104", "libras") if not (real_data / n).is_dir()]
    if missing:
        pytest.skip(f"real recordings: no {', '.join(missing)} in {real_data}")
    return real_data


@pytest.fixture(scope="session")
def simulated_run(tmp_path_factory) -> Run:
    """The run of someone without real recordings: simulated corpora, and the rest missing.

    Made once, by the first worker that wants it; the others wait. It is not to be changed:
    `own_copy` is.
    """
    base = tmp_path_factory.getbasetemp()
    if os.environ.get("PYTEST_XDIST_WORKER"):
        base = base.parent  # that of all workers
    folder = base / "simulated-run"
    with (base / "simulated-run.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        told = base / "simulated-run.txt"
        if not told.exists():
            prepare(folder, binning={**QUICK["binning"], "bins": 40})  # 100: test_real_signs.py
            text = checked(run(folder, "--cores", "2")).text
            told.write_text(text, encoding="utf-8")
        return Run(folder, 0, told.read_text(encoding="utf-8"))


@pytest.fixture
def own_copy(simulated_run, tmp_path) -> Run:
    """A copy of that run, times and Snakemake's records too."""
    folder = shutil.copytree(simulated_run.folder, tmp_path / "copy")
    return Run(folder, simulated_run.status, simulated_run.text)
