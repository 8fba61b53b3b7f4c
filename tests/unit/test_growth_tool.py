"""What `python -m tools.growth` writes of what it measured: tables between marks, and a figure."""

from __future__ import annotations

import json
from dataclasses import asdict

import pytest

from tools import growth


@pytest.fixture
def folder(tmp_path):
    """Two sizes of one kind, as files: CPU of a recording is the same, one job is kernels'."""
    for size in (100, 10):
        costs = [
            {"rule": "compile_kernels", "about": "", "seconds": 80, "cpu_s": 80, "peak_mb": 900},
            {
                "rule": "ingest",
                "about": "c 0001",
                "seconds": 1,
                "cpu_s": size * 0.4,
                "peak_mb": 290,
            },
            {"rule": "claims", "about": "", "seconds": 1, "cpu_s": size * 0.1, "peak_mb": 583},
        ]
        again = growth.Again(3, 1.0, 2.0)
        made = growth.Measured("tagged", size, costs, 60.0, 5.0, 6.0, again, again)
        (tmp_path / f"tagged-{size}.json").write_text(json.dumps(asdict(made)))
    return tmp_path


def test_kept_sizes_come_back_in_order_and_kernels_do_not_count(folder):
    found = growth.kept(folder)
    assert [m.recordings for m in found] == [10, 100]
    assert [m.cpu_s for m in found] == pytest.approx([0.5, 0.5])
    assert found[1].row == "| 100 | 2 | 60 | 50 | 0.50 | 40 (ingest) | 583 (claims) | 5 |"
    assert found[1].row_again == "| 100 | 6 | 3, 1, 2 | 3, 1, 2 |"
    assert growth.by_rule(found).splitlines()[2:] == [
        "| ingest | 0.400 | 0.400 |", "| claims | 0.100 | 0.100 |",
    ]  # fmt: skip


def test_the_page_and_the_figure_are_written(folder, monkeypatch):
    page, figure = folder / "performance.md", folder / "growth.svg"
    page.write_text(growth.PAGE.read_text(encoding="utf-8"), encoding="utf-8")
    monkeypatch.setattr(growth, "PAGE", page)
    monkeypatch.setattr(growth, "FIGURE", figure)
    growth.write(folder)
    assert "| 100 | 2 | 60 | 50 | 0.50 |" in page.read_text(encoding="utf-8")
    first = figure.read_bytes()
    growth.write(folder)
    assert figure.read_bytes() == first
    assert first.count(b"<use") >= 6  # a marker a size in each of three panels
