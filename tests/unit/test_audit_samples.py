"""Samples behind a mean and an SD: counted as brute force counts, made so that they print so."""

from fractions import Fraction
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np
import pytest

from signkin.__main__ import main
from signkin.audit import closure
from signkin.audit.closure import count_samples
from signkin.audit.commands import findings_of
from signkin.audit.grim import grim
from signkin.audit.rounding import allowed
from signkin.audit.sprite import draw_samples
from signkin.audit.whole import Span


@pytest.mark.parametrize("solved", [0, closure.MOST_SOLVED])
def test_samples_are_counted_as_brute_force_lists_them(monkeypatch, solved):
    monkeypatch.setattr(closure, "MOST_SOLVED", solved)  # 0: by sums and squares alone
    rng = np.random.default_rng(0)
    for _ in range(60):
        n, low = int(rng.integers(1, 7)), int(rng.integers(-3, 3))
        high = low + int(rng.integers(0, 6))
        x = rng.integers(low, high + 1, n)
        pairs = {(int(x.sum()) + a, int((x**2).sum()) + b) for a in (-1, 0, 1) for b in (0, 2, 3)}
        listed = [
            s for s in combinations_with_replacement(range(low, high + 1), n)
            if (sum(s), sum(v * v for v in s)) in pairs
        ]  # fmt: skip
        found = count_samples(n, pairs, low, high)
        assert found.samples == len(listed)
        assert set(found.values) == {v for s in listed for v in s}
        copies = [[s.count(v) for s in listed] for v in found.values]
        assert found.least == tuple(map(min, copies))
        assert found.most == tuple(map(max, copies))
        assert found.mean == pytest.approx([np.mean(c) for c in copies])


def test_the_count_is_that_of_unsum():
    # README of unsum (CLOSURE): 2.7 (1.9), n = 100, 1 to 5; its first version held the sum to 270.
    span = Span(allowed("1.9"), Fraction(1), 99)
    found = count_samples(100, [(270, q) for q in span.squares(100, 270)], 1, 5)
    assert found.samples == 216
    assert [round(m * 216) for m in found.mean] == [11111, 957, 704, 957, 7871]


def test_what_is_too_much_is_not_counted(tmp_path):
    wide = {"mean": "562", "sd": "87", "n": "60", "grain": "1", "low": "0", "high": "1000"}
    (found,) = findings_of("closure", wide, tmp_path)
    assert found.verdict == "undecidable"
    assert found.why == "too many samples to count; `sprite` shows some"


def drawn(mean, sd, n, low, high, draws, rng):
    span = Span(allowed(sd), Fraction(1), n - 1)
    sums = grim(mean, n).sums
    return draw_samples(n, sums, lambda total: span.squares(n, total), low, high, draws, rng)


PRINTS = [
    ("5.0", "2.78", 30, 1, 8), ("2.9", "1.99", 50, 1, 5), ("3.00", "2.05", 20, 1, 5),
    ("562", "87", 60, 0, 1000), ("5.0", "2.78", 30, None, None), ("3.21", "1.20", 10_000, 1, 5),
    ("3.00", "0.00", 20, 1, 5), ("0.35", "0.49", 20, 0, 1),
]  # fmt: skip


@pytest.mark.parametrize("mean, sd, n, low, high", PRINTS)
def test_samples_made_print_so(mean, sd, n, low, high):
    found = drawn(mean, sd, n, low, high, 5, np.random.default_rng(1))
    assert found
    for x in found:
        assert len(x) == n
        total, squares = sum(x.tolist()), sum(v * v for v in x.tolist())
        assert Fraction(total, n) in allowed(mean)
        variance = Fraction(n * squares - total * total, n * (n - 1))
        assert max(0, allowed(sd).low) ** 2 <= variance <= allowed(sd).high ** 2
        assert low is None or (low <= x[0] and x[-1] <= high)


def test_existing_samples_are_found_again():
    rng = np.random.default_rng(2)
    for _ in range(150):
        low, high = 1, int(rng.choice([2, 5, 7, 11, 100]))
        n = int(rng.integers(2, 60))
        x = np.rint(low + (high - low) * rng.beta(*rng.uniform(0.3, 3, 2), n)).astype(int)
        mean, sd = f"{x.mean():.2f}", f"{x.std(ddof=1):.2f}"
        assert drawn(mean, sd, n, low, high, 2, rng), (mean, sd, n)


PAPER = """paper: Me 2026
study: mine
claims:
  - {id: A, location: p. 1, claim: So., needs: nothing, corpora: {missing: print}, published:
      {checks: [
        {check: closure, table: t.csv, grain: '1', low: '1', high: '5', reads: Points.},
        {check: sprite, table: t.csv, grain: '1', low: '1', high: '5', reads: Points.}]}}
"""


def test_the_page_draws_them_and_one_bad_row_stops_none(tmp_path, capsys):
    folder = tmp_path / "p"
    folder.mkdir()
    (folder / "claims.yaml").write_text(PAPER)
    (folder / "t.csv").write_text("g,n,mean,sd\na,20,3.00,1.30\nb,20,x,1.30\nc,53,3.21,1.20\n")
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    assert "t.csv, line 3: 'x' is no number" in capsys.readouterr().err
    names = {path.name for path in Path(tmp_path / "page").glob("samples-*")}
    assert names == {f"samples-A-{i}.{kind}" for i in (1, 2) for kind in ("svg", "pdf")}
    page = (tmp_path / "page/index.html").read_text()
    assert page.count("Possible data, not likely data.") >= 2
    first = (tmp_path / "page/samples-A-2.svg").read_bytes()
    assert main(["audit", str(folder), "--to", str(tmp_path / "again")]) == 1
    assert (tmp_path / "again/samples-A-2.svg").read_bytes() == first
