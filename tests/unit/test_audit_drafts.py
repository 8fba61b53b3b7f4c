"""Drafts of claims: from running text, tables in it, and the text layer of a PDF."""

import builtins

import pytest
import yaml

from signkin import SignkinError
from signkin.__main__ import main
from signkin.audit.drafts import from_text
from signkin.audit.init import draft_of
from signkin.audit.paper import read_paper

TEXT = """Age had an effect, t(38) = 2.10, p = .042. Then b = 0.42, SE = 0.16, 95% CI [0.10, 0.74],
p = .010. Ratings rose (n = 28, M = 5.19, SD = 1.20); OR = 2.10 (95% CI: 1.20 to 3.68).
d = 0.5, 95% CI [0.1, 0.9]. And 95% CI [0.1, 0.9] alone. M = 4.1, SE = 0.2.

Group        N    M (SD)        Age
-----------------------------------
Signers      20   3.45 (1.20)   31
Hearing      22   3.10 (1.05)   29
The end of it.

| sample | n | mean | sd |
|---|---|---|---|
| a | 33 | 3.14 | 5.32 |
"""


def checks_of(draft):
    claims = yaml.safe_load("claims:\n" + "\n".join(draft.claims))["claims"]
    return {c["id"]: (c["location"], c["published"].get("checks", [])) for c in claims}


def test_intervals_and_means_keep_their_place_and_their_questions():
    draft = from_text(TEXT)
    found = checks_of(draft)
    assert found["I001"] == ("line 1", [{
        "check": "confidence_interval", "estimate": "0.42", "low": "0.10", "high": "0.74",
        "level": "95", "se": "0.16", "p": ".010",
        "reads": "The estimate lies in the middle of its interval, as it is or as a logarithm.",
    }])  # fmt: skip
    assert found["I002"][1][0]["estimate"] == "2.10"
    assert found["M001"] == ("line 2", [])  # its grain is asked for, not guessed
    assert 'n: "28"' in draft.claims[3]
    assert "spread: se" in draft.claims[4]  # n does not stand beside it
    assert [line.partition(": ")[2] for line in draft.not_understood] == [
        "95% CI [0.1, 0.9] (the interval of d need not be symmetric)",
        "95% CI [0.1, 0.9] (no estimate stands before this interval)",
    ]


def test_intervals_that_may_be_skewed_are_asked_about():
    draft = from_text("By bootstrap, b = 0.42, 95% CI [0.10, 0.94].")
    assert checks_of(draft)["I001"][1] == []
    assert "`bootstrap` stands in the text" in draft.claims[0]


def test_tables_of_a_text_are_found(tmp_path, capsys):
    (tmp_path / "paper.txt").write_text(TEXT)
    assert main(["audit", "init", str(tmp_path / "paper.txt"), "--to", str(tmp_path / "p")]) == 0
    assert "7 claims in" in capsys.readouterr().out
    table = (tmp_path / "p/paper-table1.csv").read_text()
    assert table == "Group,N,M,SD,Age\nSigners,20,3.45,1.20,31\nHearing,22,3.10,1.05,29\n"
    assert (tmp_path / "p/paper-table2.csv").read_text() == "sample,n,mean,sd\na,33,3.14,5.32\n"
    assert len(read_paper(tmp_path / "p").claims) == 7
    assert main(["audit", str(tmp_path / "p"), "--to", str(tmp_path / "page")]) == 0


def pdf(*pages):
    """A PDF of text alone, made by hand: each page a list of (x, y, text)."""
    parts = [
        b"<</Type/Catalog/Pages 2 0 R>>",
        b"",
        b"<</Type/Font/Subtype/Type1/BaseFont/Courier>>",
    ]
    kids = []
    for page in pages:
        marks = "".join(f"BT /F 9 Tf {x} {y} Td ({text}) Tj ET\n" for x, y, text in page).encode()
        parts.append(b"<</Length %d>>stream\n%sendstream" % (len(marks), marks))
        kids.append(len(parts) + 1)
        parts.append(b"<</Type/Page/Parent 2 0 R/MediaBox[0 0 600 800]/Contents %d 0 R"
                     b"/Resources<</Font<</F 3 0 R>>>>>>" % len(parts))  # fmt: skip
    listed = b" ".join(b"%d 0 R" % kid for kid in kids)
    parts[1] = b"<</Type/Pages/Kids[%s]/Count %d>>" % (listed, len(kids))
    out, places = b"%PDF-1.4\n", []
    for number, part in enumerate(parts, 1):
        places.append(len(out))
        out += b"%d 0 obj" % number + part + b"endobj\n"
    start = len(out)
    out += b"xref\n0 %d\n0000000000 65535 f \n" % (len(parts) + 1)
    out += b"".join(b"%010d 00000 n \n" % place for place in places)
    out += b"trailer<</Root 1 0 R/Size %d>>\nstartxref\n%d\n%%%%EOF" % (len(parts) + 1, start)
    return out


def rows(lines, top=700):
    return [(x, top - 14 * i, text) for i, line in enumerate(lines) for x, text in line]


TABLE = [
    [(50, "group"), (200, "n"), (260, "mean"), (330, "sd")],
    [(50, "signers"), (200, "33"), (260, "3.14"), (330, "5.32")],
    [(50, "hearing"), (200, "34"), (260, "2.68"), (330, "2.59")],
]


def test_a_pdf_is_read_page_by_page(tmp_path):
    pytest.importorskip("pypdf", reason="the extra pdf is not installed")
    text = [[(50, "We found t\\(38\\) = 2.10, p = .042, and F\\(2, 57\\) = 3.10, p = .005.")]]
    (tmp_path / "paper.pdf").write_bytes(pdf(rows(text), rows(TABLE)))
    draft = draft_of(tmp_path / "paper.pdf")
    found = checks_of(draft)
    assert found["S001"][0].startswith("page 1, line 1")
    assert found["S002"][1][0]["statistic"] == "3.10"
    assert found["T001"][0].startswith("page 2, line ")
    assert draft.tables["paper-table1.csv"].splitlines()[1] == "signers,33,3.14,5.32"


@pytest.mark.parametrize(
    "content, sentence",
    [
        (pdf(rows(TABLE))[:300], "it cannot be read as a PDF|no text layer"),
        (b"%PDF-1.4\n", "it cannot be read as a PDF"),
        (pdf([]), "it has no text layer"),
    ],
)
def test_a_pdf_that_cannot_be_used_is_one_sentence(tmp_path, content, sentence):
    pytest.importorskip("pypdf", reason="the extra pdf is not installed")
    (tmp_path / "bad.pdf").write_bytes(content)
    with pytest.raises(SignkinError, match=sentence):
        draft_of(tmp_path / "bad.pdf")


def test_without_pypdf_one_is_told_what_to_do(tmp_path, monkeypatch, capsys):
    real = builtins.__import__

    def without(name, *rest, **more):
        if name == "pypdf":
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    (tmp_path / "a.pdf").write_bytes(b"%PDF-1.4\n")
    assert main(["audit", "init", str(tmp_path / "a.pdf")]) == 1
    told = capsys.readouterr().err
    assert "pip install 'signkin[pdf]'" in told
    assert "pdftotext -layout" in told
    assert told.count("\n") == 1
