"""docs/adding-a-corpus.md as it stands: three folders become corpora, and corpora a report.

The motion is that of real files of each format; the tags are made here.
"""

import re
import shlex
import shutil

import pytest
import yaml

from signkin import Interval
from signkin.__main__ import main
from signkin.io.eaf_write import new_eaf
from signkin.unavailable import rows_of
from support.in_process import run_in_process
from support.less import LESS
from support.runs import prepare

FENCE = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
MOST_ANSWERS = 5


def tags(end_s):
    """Return signs of 0.35 s with 0.2 s between them."""
    starts = [0.3 + 0.55 * k for k in range(int((end_s - 0.8) / 0.55))]
    return [Interval(t, t + 0.35, ("HOUSE", "IX", "CAT")[k % 3], "") for k, t in enumerate(starts)]


def elan(path, end_s):
    path.write_bytes(new_eaf(
        author="t", date="2020-01-01T00:00:00Z", media_url="v.mp4",
        tiers=[("Gloss", None, tags(end_s))],
    ))  # fmt: skip


def text_grid(path, end_s):
    signs = "".join(
        f"    intervals [{i}]:\n        xmin = {t.start_s}\n        xmax = {t.end_s}\n"
        f'        text = "{t.label}"\n'
        for i, t in enumerate(tags(end_s), start=1)
    )
    path.write_text(
        'File type = "ooTextFile"\nObject class = "TextGrid"\n\nxmin = 0\n'
        f"xmax = {end_s}\ntiers? <exists>\nsize = 1\nitem []:\n    item [1]:\n"
        '        class = "IntervalTier"\n        name = "glosses"\n        xmin = 0\n'
        f"        xmax = {end_s}\n        intervals: size = {len(tags(end_s))}\n{signs}"
    )


FOLDERS = {
    "mocap": ("c3d/gesture.c3d", "eaf", elan, 3.2),
    "tracked": ("pose/mediapipe.pose", "eaf", elan, 7),
    "table": ("tables/masked_piper_body.csv", "TextGrid", text_grid, 7),
}


@pytest.fixture
def home(real_data, tmp_path, monkeypatch):
    """A home with the three folders of recordings, and a working directory beside them."""
    formats = real_data / "formats"
    if not formats.is_dir():
        pytest.skip(f"files of formats: no folder formats in {real_data}")
    pytest.importorskip("ezc3d", reason="the optional library ezc3d is not there")
    for name, (source, suffix, write, end_s) in FOLDERS.items():
        folder = tmp_path / "recordings" / name
        folder.mkdir(parents=True)
        shutil.copy(formats / source, folder / f"take1.{source.rpartition('.')[2]}")
        write(folder / f"take1.{suffix}", end_s)
    prepare(tmp_path / "work", corpora="all", **LESS)
    monkeypatch.chdir(tmp_path / "work")
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def answer(path, body):
    """Put a person's answers in the place of what `init` guessed; return how many there are."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for told in body.splitlines():
        key = told.partition(":")[0]
        (at,) = [i for i, line in enumerate(lines) if line.strip().startswith(f"{key}:")]
        indent = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
        lines[at] = indent + told
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def made(home, line):
    """Run `make DATA=... ARGS=...`, its jobs in this process."""
    words = dict(word.split("=", 1) for word in shlex.split(line)[1:])
    corpora = yaml.safe_load(words["ARGS"].removeprefix("--config corpora="))
    prepare(home / "work", corpora=corpora, **LESS)
    return run_in_process(home / "work", home / words["DATA"].removeprefix("~/"))


@pytest.fixture
def walked(root, home, capsys):
    """The page read from top to end; returns how much each `init` asked, and the `make` lines."""
    text = (root / "docs/adding-a-corpus.md").read_text(encoding="utf-8")
    page = text[text.index("## Walk-through") : text.index("## What `init` and `check` do")]
    out, asked, made_by = "", [], []
    for kind, name, body in FENCE.findall(page):
        if kind == "sh":
            for line in body.splitlines():
                if line.startswith("make "):
                    made_by.append(line)
                    continue
                words = shlex.split(line.replace("~", str(home)))
                assert words[0] == "signkin"
                assert main(words[1:]) == 0, capsys.readouterr()
                out = capsys.readouterr().out
                if words[2] == "init":
                    asked.append(len(re.findall(r"^ +\d+\. ", out, re.MULTILINE)))
        elif kind == "expect":
            for line in body.splitlines():
                assert line in out
        elif kind == "yaml":
            assert answer(home / "work" / name, body)["licence"] != "unknown"
        else:
            assert kind == "csv"
            (home / "work" / name).write_text(body, encoding="utf-8")
    return asked, made_by


def test_init_asks_at_most_five_questions_and_check_finds_nothing_wrong(walked):
    asked, made_by = walked
    assert len(asked) == len(FOLDERS)
    assert max(asked) <= MOST_ANSWERS
    assert len(made_by) == 1


def test_make_comes_to_the_report_of_all_three(walked, home):
    done = made(home, walked[1][0])
    assert done[-1].rule == "report"
    assert not done[-1].failed, done[-1]
    for name in FOLDERS:
        moves = (home / f"work/results/naert2017/{name}/transitions.csv").read_text()
        assert moves.count("\n") > 3
        reasons = rows_of(home / f"work/results/{name}/not_available")["reason"]
        assert not reasons.str.contains("fault of signkin").any(), reasons.tolist()
