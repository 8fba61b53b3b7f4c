"""Tables, stores, seeds, digests, the job frame: what every rule stands on."""

import sys
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from signkin import Recording, SignkinError, provenance, seeds, tables
from signkin.io.store import read_recordings, recording_names, write_recordings
from signkin.job import job


def test_the_data_dictionary_is_up_to_date(root):
    found = (root / "docs/data-dictionary.md").read_text(encoding="utf-8")
    assert found == tables.dictionary(), "run: python -m signkin.tables > docs/data-dictionary.md"


def test_tables_keep_text_and_empty_cells(tmp_path):
    frame = pd.DataFrame(
        [["c", "0000", 3, 0.1 + 0.2, np.nan, *[np.nan] * 3, *[""] * 6, "yes", "NA"]],
        columns=tables.TABLES["table2"].names(),
    )
    tables.write_table(frame, tmp_path / "t.csv", "table2")
    assert "0.3,," in (tmp_path / "t.csv").read_text()
    again = tables.read_table(tmp_path / "t.csv", "table2")
    assert again.loc[0, ["type", "note", "printed_n"]].tolist() == ["0000", "NA", ""]
    assert np.isnan(again.loc[0, "sd_s"])


def test_a_table_with_other_columns_is_not_written(tmp_path):
    with pytest.raises(SignkinError, match=r"columns missing: recording.*; not declared: x"):
        tables.write_table(pd.DataFrame({"x": [1]}), tmp_path / "t.csv", "truth")
    assert not (tmp_path / "t.csv").exists()


def test_tables_are_concatenated_in_the_order_given(tmp_path):
    names = tables.TABLES["truth"].names()
    for i in (1, 2, 3):
        rows = [] if i == 2 else [[f"r{i}", 1, "start", "right", 0.5]]
        tables.write_table(pd.DataFrame(rows, columns=names), tmp_path / f"{i}.csv", "truth")
    paths = [tmp_path / f"{i}.csv" for i in (3, 2, 1)]
    assert tables.concatenated(paths, "truth")["recording"].tolist() == ["r3", "r1"]
    assert tables.concatenated(paths[1:2], "truth").empty


def take(name, seed, quaternions=True):
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(30 + seed, 2, 3))
    positions[3, 1] = np.nan
    q = rng.normal(size=(30 + seed, 2, 4))
    return Recording(
        name=name, rate_hz=29.97, joints=("right_wrist", "left_wrist"), positions=positions,
        orientations=q / np.linalg.norm(q, axis=2, keepdims=True) if quaternions else None,
        orientation_source="recorded" if quaternions else "none", parents=(-1, 0),
    )  # fmt: skip


def test_recordings_come_back_as_they_were_stored(tmp_path):
    path = tmp_path / "r.parquet"
    written = [take("b", 1), take("a", 2)]
    write_recordings(path, written)
    assert recording_names(path) == ["b", "a"]
    for before, after in zip(written, read_recordings(path), strict=True):
        assert (before.name, before.rate_hz, before.parents) == (
            after.name, after.rate_hz, after.parents,
        )  # fmt: skip
        np.testing.assert_array_equal(before.positions, after.positions)
        np.testing.assert_array_equal(before.orientations, after.orientations)
    assert [r.name for r in read_recordings(path, ["a"])] == ["a"]
    first = path.read_bytes()
    write_recordings(path, written)
    assert path.read_bytes() == first


def test_a_store_holds_one_kind_of_recording(tmp_path):
    with pytest.raises(SignkinError, match="b and a differ in joints, unit or orientations"):
        write_recordings(tmp_path / "r.parquet", [take("a", 1), take("b", 2, quaternions=False)])
    pd.DataFrame({"x": [1]}).to_parquet(tmp_path / "p.parquet")
    with pytest.raises(SignkinError, match="no signkin metadata"):
        recording_names(tmp_path / "p.parquet")


def test_streams_depend_on_their_names_alone():
    a, b, again = (seeds.stream(1, *n).random(3) for n in (("c", "r1"), ("c", "r2"), ("c", "r1")))
    assert (a == again).all()
    assert not (a == b).any()
    assert not (seeds.stream(2, "c", "r1").random(3) == a).any()
    # ("ab", "c") and ("a", "bc") are other streams.
    assert not (seeds.stream(1, "ab", "c").random(3) == seeds.stream(1, "a", "bc").random(3)).any()


@pytest.fixture
def package(tmp_path, monkeypatch):
    home = tmp_path / "signkin"
    files = {
        "__init__.py": "",
        "a.py": "from signkin.sub import b\n",
        "sub/__init__.py": "",
        "sub/b.py": (
            "def f(x):\n    match x:\n        case 1:\n            try:\n                x()\n"
            "            except ValueError:\n                from signkin import late\n"
        ),
        "sub/page.html": "<p>",
        "late.py": "x = 1\n",
        "other.py": "y = 1\n",
        "typing_only.py": "z = 1\n",
    }
    for name, text in files.items():
        (home / name).parent.mkdir(parents=True, exist_ok=True)
        (home / name).write_text(text)
    monkeypatch.setattr(provenance, "PACKAGE", home)
    script = tmp_path / "script.py"
    script.write_text(
        "from typing import TYPE_CHECKING\nwith open('x'):\n    from signkin import a\n"
        "if TYPE_CHECKING:\n    import signkin.typing_only\n"
    )

    def forget():
        for cached in (provenance._imports, provenance._files_of, provenance._data_files):
            cached.cache_clear()

    def digest():
        forget()
        return provenance.code_digest(script)

    yield home, script, digest
    forget()


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("a.py", True), ("sub/b.py", True), ("sub/page.html", True), ("late.py", True),
        ("other.py", False), ("typing_only.py", False),
    ],
)  # fmt: skip
def test_a_digest_follows_what_a_script_imports(package, name, changes):
    home, script, digest = package
    before = digest()
    assert digest() == before
    (home / name).write_text((home / name).read_text() + "# edited\n")
    assert (digest() != before) == changes
    script.write_text(script.read_text() + "# edited\n")
    assert digest() != before


def test_a_digest_is_the_same_before_and_after_code_is_compiled(package):
    home, _, digest = package
    before = digest()
    kept = home / "sub/__pycache__"
    kept.mkdir()
    for name in ("b.f-1.py311.nbi", "b.f-1.py311.1.nbc", "b.cpython-311.pyc"):
        (kept / name).write_text("compiled")
    assert digest() == before


def test_every_workflow_script_has_a_digest(root):
    scripts = sorted((root / "workflow/scripts").rglob("*.py"))
    assert len({provenance.code_digest(script) for script in scripts}) == len(scripts) > 30


def run_job(tmp_path, body):
    terminal = SimpleNamespace(text="", write=None, flush=lambda: None)
    terminal.write = lambda t: setattr(terminal, "text", terminal.text + t)
    sys.stderr, kept = terminal, sys.stderr
    try:
        with job(
            SimpleNamespace(
                log=[str(tmp_path / "logs/x.log")], rule="x", wildcards=["c"], output=[]
            )
        ):
            print("progress")
            body()
    finally:
        sys.stderr = kept
    return terminal.text


def test_a_users_error_is_one_sentence_and_ends_the_job(tmp_path, capsys):
    def fail():
        raise SignkinError("found this", file="f.csv", place="line 3")

    with pytest.raises(SystemExit) as stop:
        run_job(tmp_path, fail)
    assert stop.value.code == 1
    log = (tmp_path / "logs/x.log").read_text()
    assert log == "progress\nsignkin: f.csv, line 3: found this.\n"


def test_a_programming_error_leaves_its_traceback(tmp_path):
    with pytest.raises(SystemExit):
        run_job(tmp_path, lambda: 1 / 0)
    assert "ZeroDivisionError" in (tmp_path / "logs/x.log").read_text()


def test_a_job_that_works_says_nothing(tmp_path):
    assert run_job(tmp_path, lambda: None) == ""
