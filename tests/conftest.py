"""Fixtures that all layers share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from support.runs import Run, checked, prepare, run

ROOT = Path(__file__).resolve().parents[1]


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
    """The run of someone without real recordings: simulated corpora, and the rest missing."""
    folder = prepare(tmp_path_factory.mktemp("simulated") / "run")
    return checked(run(folder, "--cores", "2"))


@pytest.hookimpl(tryfirst=True)  # xdist reads the groups in the same hook
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give all tests of one run of the workflow to one worker: the run is made once."""
    for item in items:
        for name in ("simulated_run", "real_run", "signs_run"):
            if name in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.xdist_group(name))
