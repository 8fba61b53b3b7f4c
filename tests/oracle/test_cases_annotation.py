"""Small files that were read or written wrongly: each of a kind, with the right value.

They are made for the purpose and lie outside the project; `SIGNKIN_CASES` names their folder.
A case that the folder has and this file does not know fails, so that none passes unseen.
"""

from __future__ import annotations

import json
import os
import runpy
import shlex
import sys
import unicodedata
from pathlib import Path

import pytest

FOLDER = Path(os.environ.get("SIGNKIN_CASES", "/work/shared/cases")) / "annotation"
if not FOLDER.is_dir():
    pytest.skip(f"no folder of cases ({FOLDER})", allow_module_level=True)

CASES = sorted(path.name for path in FOLDER.iterdir() if (path / "case.json").is_file())
HAUS = [["Gloss", "HAUS", 0.1, 0.4]]


def show(case: str, arguments: list[str], monkeypatch, capsys) -> dict[str, object]:
    """Run the folder's own `show.py` on a case."""
    monkeypatch.chdir(FOLDER / case)
    monkeypatch.setattr(sys, "argv", ["show.py", *arguments])
    capsys.readouterr()
    runpy.run_path(str(FOLDER / "show.py"), run_name="__main__")
    return json.loads(unicodedata.normalize("NFC", capsys.readouterr().out))


def called(case: str, call: str, target: Path, monkeypatch, capsys) -> dict[str, object]:
    """Run the call that case.json gives; what it writes goes elsewhere."""
    if call.startswith("python -c"):  # a loop over files
        files = [p.name for p in sorted((FOLDER / case).iterdir()) if f"'{p.name}'" in call]
        assert files
        return {name: show(case, ["read", name], monkeypatch, capsys) for name in files}
    arguments = shlex.split(call)[2:]
    if arguments[0] == "insert":
        arguments[2] = str(target)
    return show(case, arguments, monkeypatch, capsys)


def told(result: object) -> str:
    assert isinstance(result, dict)
    assert "SignkinError" in result, result
    assert "\n" not in result["SignkinError"]
    return result["SignkinError"]


@pytest.mark.parametrize("case", CASES)
def test_case(case, tmp_path, monkeypatch, capsys):
    text = unicodedata.normalize("NFC", (FOLDER / case / "case.json").read_text(encoding="utf-8"))
    told_case = json.loads(text)
    expected = told_case["expected"]
    result = called(case, told_case["call"], tmp_path / "out.eaf", monkeypatch, capsys)
    assert "CRASH" not in json.dumps(result)
    if case.startswith("26"):
        assert "slot ts1 has TIME_VALUE 100.0" in told(result["float.eaf"])
        assert "whole milliseconds" in told(result["float.eaf"])
        assert "annotation a1 has no ANNOTATION_VALUE" in told(result["novalue.eaf"])
        assert "line 1, column" in told(result["stray.eaf"])
        assert "not well-formed XML" in told(result["stray.eaf"])
    elif case.startswith("20"):
        assert result["intervals"] == HAUS
    elif case.startswith("16"):
        assert "line 2" in told(result["extra.csv"])
        right = expected["trailing.csv"]["intervals"]
        if "intervals" in result["trailing.csv"]:
            assert result["trailing.csv"]["intervals"] == right
        else:
            assert "line 2" in told(result["trailing.csv"])
    elif case.startswith("15"):
        assert "output is not well-formed" not in result
        assert b"FL&#220;GEL" in (tmp_path / "out.eaf").read_bytes()
    elif "each file" in expected:
        for one in result.values():
            assert one["intervals"] == expected["each file"]["intervals"]
    elif "SignkinError" in expected:
        assert expected["SignkinError"] in told(result)
    elif "intervals" in expected:
        assert result["intervals"] == expected["intervals"]
    else:
        known = {key: value for key, value in expected.items() if key in result}
        assert known
        assert {key: result[key] for key in known} == known
        assert result["second insertion changes bytes"] is False
        assert result["annotation ids used twice"] == []
        assert result["linguistic types declared twice"] == []
