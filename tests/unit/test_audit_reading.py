"""Claims that come in: bad files are one sentence each, texts and tables become claims."""

import json
import re
import time

import pytest

from signkin import SignkinError
from signkin.__main__ import main
from signkin.audit.apa import statistics_in
from signkin.audit.claims_file import read_claims
from signkin.audit.ledger import audit
from signkin.audit.paper import read_paper

HEAD = "paper: Me 2026\nstudy: mine\nclaims:\n"
CLAIM = (
    "  - {{id: {id}, location: p. 1, claim: So., needs: nothing, corpora: {{missing: print}},\n"
    "     published: {{checks: [{check}]}}}}\n"
)
GOOD = "{check: grim, mean: '2.50', n: '4', grain: '1', reads: So.}"


def paper(folder, claims, **files):
    folder.mkdir(exist_ok=True)
    text = claims if isinstance(claims, bytes) else claims.encode()
    (folder / "claims.yaml").write_bytes(text)
    for name, content in files.items():
        (folder / f"{name}.csv").write_text(content)
    return folder


def claim(name, check=GOOD):
    return CLAIM.format(id=name, check=check)


def bomb(levels):
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    for i in range(1, levels):
        lines.append(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]")
    return "\n".join(lines)


@pytest.mark.parametrize(
    "text, sentence",
    [
        ("", r"claims.yaml: it is empty"),
        ("# nothing\n", r"claims.yaml: it is empty"),
        ("- a\n", r"is not of type 'object'"),
        (HEAD, r"line 3: None is not of type 'array'"),
        (HEAD + "  - {id: A, claim: \xe9}\n", r"line 4: byte 0xe9 is not UTF-8"),
        ("a: " + "[" * 2000 + "]" * 2000, r"it (is nested too deep|has more than 40 levels)"),
        (bomb(9), r"too many parts"),
        (HEAD + claim("A") + "study: other\n", r"line 6: the key 'study' stands there twice"),
        ("paper: [", r"line 1"),
        ("paper: x\nstudy: 2024-13-45\nclaims: []\n", r"line 2|month"),
    ],
)
def test_a_file_that_cannot_be_used_is_one_sentence(tmp_path, capsys, text, sentence):
    folder = paper(tmp_path / "p", text.encode("latin-1"))
    start = time.process_time()
    with pytest.raises(SignkinError, match=sentence):
        read_claims(folder / "claims.yaml")
    assert time.process_time() - start < 20
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    assert capsys.readouterr().err.count("\n") == 1


TABLE = "g,n,mean,sd\na,4,2.50,1.29\nb,{n},2.50,{sd}\nc,4,2.25,0.50\n"


@pytest.mark.parametrize(
    "check, table, sentence",
    [
        ("{check: nothing, reads: So.}", "", r"claims.yaml, line 7: .* unknown check 'nothing'"),
        ("{check: grim, mean: '2.50', n: '4', reads: So.}", "", r"line 7: .* lacks grain"),
        ("{check: grim, mean: 2.5, n: '4', grain: '1', reads: So.}", "",
         r"line 7: mean is '2.5', and no text"),
        ("{check: grim, table: t.csv, grain: 'a third', reads: So.}", TABLE,
         r"claims.yaml, line 7: 'a third' is no number"),
        ("{check: grimmer, table: t.csv, grain: '1', divisor: n+1, reads: So.}", TABLE,
         r"claims.yaml, line 7: the divisor 'n\+1'"),
        ("{check: grim, table: t.csv, grain: '1', n: [1], reads: So.}", TABLE,
         r"claims.yaml, line 7: n is '\[1\]', and no text"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", TABLE.replace("{n}", "0"),
         r"t.csv, line 3: n is 0 beside the mean 2.50"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", TABLE.replace("{n}", "2.5"),
         r"t.csv, line 3: n is '2.5'; expected a whole number"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", TABLE.replace("{n}", "about 30"),
         r"t.csv, line 3: n is 'about 30'; expected a whole number"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", TABLE.replace("{sd}", "-0.1"),
         r"t.csv, line 3: the SD is -0.1"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", TABLE + "d,4\n",
         r"t.csv, line 5: the row has more or fewer cells"),
        ("{check: grimmer, table: t.csv, grain: '1', reads: So.}", "g,n,n,mean,sd\na,1,1,2,3\n",
         r"t.csv, line 1: the columns n stand there twice"),
        ("{check: relation, holds: 'x < 1', reads: So.}", "", r"line 7: the name 'x'"),
        ("{check: relation, holds: '2 ** 1000 < 1', reads: So.}", "", r"line 7: the power 1000"),
        ("{check: formula, value: '1 / 0', equals: '1', reads: So.}", "", r"line 7: .* by zero"),
        ("{check: formula, value: 'sqrt(-1)', equals: '1', reads: So.}", "",
         r"line 7: the square root of -1"),
        ("{check: p_value, kind: t, statistic: '2', df: 9, p: '1.5', reads: So.}", "",
         r"line 7: p is 1.5"),
    ],
)  # fmt: skip
def test_the_other_claims_go_on(tmp_path, capsys, check, table, sentence):
    table = table.replace("{n}", "4").replace("{sd}", "1.29")
    text = (
        HEAD
        + claim("A")
        + claim("B", check).replace("     published", "     published")
        + claim("C")
    )
    folder = paper(tmp_path / "p", text, t=table)
    ledger = audit([read_paper(folder)])
    verdicts = ledger.claims.set_index("id")["verdict"]
    assert verdicts["A"] == verdicts["C"] == "consistent"
    assert verdicts["B"] != "inconsistent"
    assert len(ledger.faults) == 1
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert re.search(sentence, told), told


@pytest.mark.parametrize(
    "bad, sentence",
    [
        ("  - {id: B}\n", r"line 6: 'location' is a required property"),
        (claim("A"), r"line 6: the claim A stands in line 4 already"),
        (claim("B").replace("claim: So.", "claim: So., claim: No."), r"'claim' stands there twice"),
        (claim("B").replace("needs: nothing", "printed: {m: 2.5}, needs: nothing"),
         r"2.5 is not of type 'string'"),
    ],
)  # fmt: skip
def test_a_claim_that_cannot_be_read_leaves_the_others(tmp_path, capsys, bad, sentence):
    folder = paper(tmp_path / "p", HEAD + claim("A") + bad + claim("C"))
    found = read_paper(folder)
    assert [c.id for c in found.claims] == ["A", "C"]
    assert len(found.faults) == 1
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    assert re.search(sentence, capsys.readouterr().err)


def test_a_mean_outside_the_scale_is_a_finding(tmp_path):
    scale = "grain: '1', low: '1', high: '5'"
    check = f"{{check: grimmer, mean: '5.50', sd: '1.00', n: '4', {scale}, reads: So.}}"
    ledger = audit([read_paper(paper(tmp_path / "p", HEAD + claim("A", check)))])
    assert ledger.claims["verdict"].item() == "inconsistent"
    assert "above 5, the upper end of the scale" in ledger.claims["note"].item()


@pytest.mark.parametrize("p", ["ns", "n.s.", "<.001", "\u2264 .05", ".0004", "1e-4"])
def test_p_may_be_printed_in_all_its_ways(tmp_path, p):
    check = "{check: p_value, kind: t, statistic: '4.00', df: ['40'], p: p, reads: So.}"
    text = HEAD + claim("A", check).replace("needs:", f"printed: {{p: '{p}'}}, needs:")
    found = audit([read_paper(paper(tmp_path / "p", text))])  # p = .000265
    assert found.faults == ()
    fits = p in ("<.001", "\u2264 .05")
    # One-tailed .00013: no other reading is .0004 either; 1e-4 is.
    wanted = "consistent" if fits or p == "1e-4" else "inconsistent"
    assert found.claims["verdict"].item() == wanted


# --- the page


def test_a_paper_has_its_page_with_csv_and_json(tmp_path, capsys):
    bad = "{check: grim, mean: '5.19', n: '28', grain: '1', reads: Whole points.}"
    folder = paper(tmp_path / "p", HEAD + claim("A") + claim("B", bad))
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    page = (tmp_path / "page/index.html").read_text()
    for words in ("Whole points.", "5.178571", "by hand", "would be consistent", "grain 1"):
        assert words in page
    content = json.loads((tmp_path / "page/audit.json").read_text())
    assert [c["verdict"] for c in content["claims"]] == ["consistent", "inconsistent"]
    assert (tmp_path / "page/claims.csv").is_file()
    assert (tmp_path / "page/checks.csv").is_file()
    good = paper(tmp_path / "q", HEAD + claim("A"))
    assert main(["audit", str(good), "--to", str(tmp_path / "other")]) == 0
    assert main(["audit", str(tmp_path), "--to", str(tmp_path / "all")]) == 1
    whole = (tmp_path / "all/index.html").read_text()
    assert 'href="p/index.html"' in whole
    assert (tmp_path / "all/q/audit.json").is_file()


# --- drafts

TEXT = """We found an effect of age, t(38) = 2.10,
p = .042, and F(2, 57) = 3.10, p = .25. By Welch t(22.63) = \u22122.99, p = .007.
\u03c7 2 (1, N = 52) = 8.05, p < .01. Odd: F(3) = 2, p = .2. z = 0.40, ns.
H(2) = 6.1, p = .047; r(56) = .34, p = 9.0 \u00d7 10\u22123; t(20) = 2.4, d = 0.5, p = .026.
"""


def test_statistics_keep_their_place_and_what_is_not_read_is_told():
    found, missed = statistics_in(TEXT)
    assert [(s.kind, s.df, s.statistic, s.p, s.line) for s in found] == [
        ("t", ("38",), "2.10", ".042", 1),
        ("F", ("2", "57"), "3.10", ".25", 2),
        ("t", ("22.63",), "-2.99", ".007", 2),
        ("chi2", ("1",), "8.05", "<.01", 3),
        ("z", (), "0.40", "ns", 3),
        ("H", ("2",), "6.1", ".047", 4),
        ("r", ("56",), ".34", "9.0e-3", 4),
        ("t", ("20",), "2.4", ".026", 4),
    ]
    assert found[0].column == 28
    assert [(m.line, m.raw[:4]) for m in missed] == [(3, "F(3)")]


def test_a_text_becomes_claims_that_can_be_audited(tmp_path, capsys):
    (tmp_path / "paper.txt").write_text(TEXT)
    assert main(["audit", "init", str(tmp_path / "paper.txt"), "--to", str(tmp_path / "p")]) == 0
    assert "not understood: line 3: F(3) = 2" in capsys.readouterr().out
    text = (tmp_path / "p/claims.yaml").read_text()
    assert "# ? tails" in text
    assert "# not understood: line 3" in text
    found = audit([read_paper(tmp_path / "p")]).claims.set_index("location")["verdict"]
    assert len(found) == 8
    assert found["line 2, column 15"] == "inconsistent"
    assert (found == "consistent").sum() == 7
    assert main(["audit", "init", str(tmp_path / "paper.txt"), "--to", str(tmp_path / "p")]) == 1
    assert "there is a claims.yaml already" in capsys.readouterr().err


def test_a_table_becomes_claims_with_questions(tmp_path, capsys):
    table = "group;N;M (SD);other\na;28;5,1 (1.2);x\n".replace("5,1", "5.1")
    (tmp_path / "t.csv").write_text(table + "b;30;4.9 (1.1);y\n")
    assert main(["audit", "init", str(tmp_path / "t.csv"), "--to", str(tmp_path / "p")]) == 0
    assert (tmp_path / "p/t.csv").read_text().splitlines()[:2] == [
        "group,N,M,SD,other", "a,28,5.1,1.2,x",
    ]  # fmt: skip
    text = (tmp_path / "p/claims.yaml").read_text()
    assert "# ? Do values come in steps" in text
    assert "check: grimmer" in text and "      #   - {check: grimmer" in text  # asked, not guessed
    assert audit([read_paper(tmp_path / "p")]).claims["verdict"].tolist() == ["consistent"]


@pytest.mark.parametrize(
    "name, content, sentence",
    [
        ("a.pdf", b"%PDF-1.4", "cannot be read as a PDF"),
        ("a.txt", b"nothing here", "nothing that could be checked"),
        ("a.txt", b"\xff\xfe", "is not UTF-8"),
        ("a.csv", b"x,y\n1,2\n", "nothing that could be checked"),
    ],
)
def test_what_has_no_claims_is_told(tmp_path, capsys, name, content, sentence):
    (tmp_path / name).write_bytes(content)
    assert main(["audit", "init", str(tmp_path / name), "--to", str(tmp_path / "p")]) == 1
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "p/claims.yaml").exists()
