"""Two trees of results are compared by what they say, and a changed file is found."""

import math
from pathlib import Path

import pandas as pd
import pytest

from signkin.__main__ import main
from signkin.errors import SignkinError
from signkin.results.comparison import compare
from signkin.results.written import differences, record, recorded, take_out_changed


@pytest.fixture
def trees(tmp_path):
    """Two folders, a writer of both: what(name, text of A, text of B)."""
    a, b = tmp_path / "a", tmp_path / "b"

    def write(name, *texts):
        for folder, text in zip((a, b), texts, strict=True):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            if text is not None:
                (folder / name).write_text(text)
        return a, b

    return write


def found(rows):
    return [(row.file, row.what, row.place, row.cells) for row in rows]


def test_last_digits_are_no_difference_and_more_is(trees):
    a, b = trees("t.csv", "n,x\n1,0.30000000000\n2,5\n", "n,x\n1,0.30000000001\n2,5\n")
    assert compare(a, b) == []
    trees("t.csv", "n,x\n1,0.3\n2,5\n", "n,x\n1,0.3\n2,5.5\n")
    (row,) = compare(a, b)
    assert found([row]) == [("t.csv", "cells", "x, row 2", 1)]
    assert row.relative == pytest.approx(0.5 / 5.5)
    assert compare(a, b, tolerance=0.1) == []


def test_text_is_compared_as_text_and_a_verdict_is_called_one(trees):
    a, b = trees("c.csv", "type,verdict\n0010,holds\n", "type,verdict\n0010,fails\n")
    trees("types.csv", "type\n0010\n", "type\n10\n")
    rows = compare(a, b)
    assert found(rows) == [
        ("c.csv", "verdict", "verdict, row 1", 1), ("types.csv", "cells", "type, row 1", 1),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("texts", "what"),
    [
        (("x\n1\n", "y\n1\n"), "columns"),
        (("x\n1\n", "x\n1\n2\n"), "rows"),
        (("x\n1\n", None), "only in A"),
        ((None, "x\n1\n"), "only in B"),
    ],
)
def test_columns_rows_and_files_that_lack(trees, texts, what):
    trees("same.csv", "x\n", "x\n")
    assert [row.what for row in compare(*trees("t.csv", *texts))] == [what]


def test_numbers_in_texts_and_empty_cells(trees):
    trees("e.csv", "x,y\n,1\n", "x,y\n,1\n")
    trees("c.txt", "r = 0.457, n = 61\n", "r = 0.4570000000001, n = 61\n")
    a, b = trees("j.json", '{"b": 1, "a": [2.0]}', '{"a": [2.1], "b": 1}')
    assert found(compare(a, b)) == [("j.json", "text", "line 3", 1)]
    trees("e.csv", "x,y\n,1\n", "x,y\n0,1\n")
    (row, _) = compare(a, b)
    assert (row.what, row.cells) == ("cells", 1) and math.isnan(row.relative)


def test_parquet_keeps_every_bit_and_pages_are_not_compared(trees):
    a, b = trees("page.html", "today", "yesterday")
    for folder, value in ((a, 1.0), (b, 1.0 + 1e-6)):
        pd.DataFrame({"x": [value, 2.0]}).to_parquet(folder / "p.parquet")
    assert found(compare(a, b)) == [("p.parquet", "cells", "x, row 1", 1)]


def test_the_command_tells_and_ends_with_1(trees, tmp_path, capsys):
    a, b = trees("t.csv", "x\n1\n", "x\n2\n")
    assert main(["compare", str(a), str(b), "--out", str(tmp_path / "d.csv")]) == 1
    assert "t.csv: cells (x, row 1) 1 differ, up to 0.5 relative: 1; 2" in capsys.readouterr().out
    assert pd.read_csv(tmp_path / "d.csv")["file"].tolist() == ["t.csv"]
    assert main(["compare", str(a), str(a)]) == 0
    with pytest.raises(SignkinError, match="no such folder"):
        compare(a, tmp_path / "nowhere")


def test_a_changed_output_is_found_and_taken_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "results/parts"
    folder.mkdir(parents=True)
    for name in ("one.csv", "two.csv"):
        (folder / name).write_text(name)
    (tmp_path / "results/alone.csv").write_text("x")
    record(["results/parts"])
    record(["results/alone.csv"])
    (tmp_path / "results/by-hand.csv").write_text("y")
    (folder / "one.csv").write_text("onf.csv")
    (folder / "two.csv").unlink()
    told = {d.path.name: d.what for d in differences(folder.parent.relative_to(tmp_path))}
    assert told == {"one.csv": "changed", "two.csv": "missing", "by-hand.csv": "not of a job"}
    assert [path.name for path in take_out_changed()] == ["one.csv"]
    assert not (folder / "one.csv").exists()
    assert take_out_changed() == []
    assert [d.what for d in differences(folder.parent.relative_to(tmp_path))] == ["not of a job"]


def test_a_later_job_counts_and_a_damaged_record_is_forgotten(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "t.csv").write_text("first")
    record(["t.csv"])
    (tmp_path / "t.csv").write_text("second")
    record(["t.csv"])
    assert take_out_changed() == []
    for path in (tmp_path / ".snakemake/signkin-written").glob("*.json"):
        path.write_text("{")
    assert recorded() == {}


def test_a_folder_with_a_changed_file_is_made_anew_whole(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = Path("results/eaf")
    folder.mkdir(parents=True)
    for name in ("a.eaf", "b.eaf", ".snakemake_timestamp"):
        (folder / name).write_text(name)
    record([folder])
    (folder / "a.eaf").write_text("other")
    assert take_out_changed() == [folder / "a.eaf"]
    assert not folder.exists()
    assert not recorded()
