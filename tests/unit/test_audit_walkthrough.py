"""docs/auditing-a-paper.md as it stands: its files, its commands, what it says they find."""

import re
import shlex

from signkin.__main__ import main

FENCE = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_the_walk_through_does_what_it_says(root, tmp_path, monkeypatch, capsys):
    text = (root / "docs/auditing-a-paper.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    statuses, told = {}, ""
    for kind, name, body in FENCE.findall(text):
        if name:  # a file, written, or over a draft
            path = tmp_path / name
            assert path.parent.is_dir()
            path.write_text(body, encoding="utf-8")
        elif kind == "sh":
            for line in body.splitlines():
                words = shlex.split(line)
                assert words[0] == "signkin"
                statuses[line] = main(words[1:])
            out = capsys.readouterr()
            assert out.err == ""
            told += out.out
        elif kind == "expect":
            page = (tmp_path / "pigs-page/claims.csv").read_text(encoding="utf-8")
            for line in body.splitlines():
                assert line in page
            assert page.count("inconsistent, ") == len(body.splitlines())
    assert [s for line, s in statuses.items() if " init " in line] == [0, 0]
    assert statuses["signkin audit pigs --to pigs-page"] == 1
    assert statuses["signkin audit results --to results-page"] == 1
    assert statuses["signkin audit check grim --mean 7.01 --n 35 --grain 1"] == 1
    assert "F(2, 57) = 3.10 has p 0.0527" in told
    assert ", one-tailed" in " ".join(told.split())
    assert "tails: one" in (tmp_path / "results/claims.yaml").read_text(encoding="utf-8")
    assert (tmp_path / "pigs-page/index.html").is_file()
