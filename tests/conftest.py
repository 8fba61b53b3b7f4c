"""Fixtures that all layers share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

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
