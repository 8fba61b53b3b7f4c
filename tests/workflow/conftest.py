"""Fixtures that run the workflow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from support.runs import prepare, write_mini


@pytest.fixture
def mini(tmp_path) -> Callable[..., tuple[Path, Path]]:
    """Return a maker of a mini corpus: (folder of the run, folder of the data)."""

    def make(spoil: Callable[[Path, Path], None] = lambda corpus, data: None, **settings: object):
        folder = prepare(tmp_path / "run", corpora=["mini"])
        corpus, data = write_mini(folder, tmp_path / "data", **settings)
        spoil(corpus, data)
        return folder, tmp_path / "data"

    return make
