"""Rounding, GRIM and GRIMMER as rules that any table must keep."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import SignkinError, audit, decimals
from signkin.audit import summaries
from signkin.audit.findings import summary
from signkin.audit.rounding import Interval, allowed, shown

PLACES = st.integers(2, 6)
FRAMES = st.lists(st.integers(5, 90), min_size=2, max_size=24)


def printed(frames, places):
    values = [Fraction(f, 100) for f in frames]
    mean, variance = decimals.mean(values), decimals.variance(values)
    return decimals.fixed(mean, places), decimals.fixed_root(variance, places + 1)


# --- rounding


def test_trailing_zeros_count():
    assert allowed("0.31").width == 10 * allowed("0.310").width
    assert allowed("1e-7").width == Fraction(1, 10**7)


@pytest.mark.parametrize(
    "rounding, inside",
    [("nearest", (True, True)), ("half_up", (True, False)), ("half_even", (True, True)),
     ("truncated", (False, True)), ("any", (True, True))],
)  # fmt: skip
def test_ties_go_as_the_rounding_says(rounding, inside):
    values = allowed("0.2", rounding)
    assert (Fraction(15, 100) in values, Fraction(25, 100) in values) == inside
    assert (Fraction(-15, 100) in allowed("-0.2", rounding)) == inside[0]


def test_half_even_leaves_ties_to_even_digits():
    assert Fraction(25, 100) not in allowed("0.3", "half_even")
    assert Fraction(25, 100) in allowed("0.2", "half_even")


@settings(deadline=None)
@given(st.fractions(-5, 5), st.integers(0, 6), st.sampled_from(["nearest", "half_up"]))
def test_a_print_allows_what_was_printed(value, places, rounding):
    text = decimals.fixed(abs(value), places)
    assert abs(value) in allowed(text, rounding)


@settings(deadline=None)
@given(st.fractions(-3, 3), st.fractions(-3, 3), st.fractions(0, 1), st.fractions(0, 1),
       st.floats(0, 1), st.floats(0, 1))  # fmt: skip
def test_interval_arithmetic_holds_every_result(a, b, wa, wb, ta, tb):
    x, y = Interval(a, a + wa), Interval(b, b + wb)
    p, q = a + wa * Fraction(ta), b + wb * Fraction(tb)
    assert p + q in x + y
    assert p - q in x - y
    assert p * q in x * y
    assert abs(p) in abs(x)
    assert p * p in x**2
    if not y.low <= 0 <= y.high:
        assert p / q in x / y


# --- GRIM and GRIMMER


@settings(deadline=None)
@given(FRAMES, PLACES)
def test_a_table_computed_from_a_sample_passes(frames, places):
    mean, sd = printed(frames, places)
    n = len(frames)
    assert audit.grim(mean, n, "0.01").verdict in ("consistent", "undecidable")
    found = audit.grimmer(mean, sd, n, "0.01", divisor="n-1")
    assert found.verdict in ("consistent", "undecidable")
    if found.pairs and found.complete:
        assert (sum(frames), sum(f * f for f in frames)) in found.pairs["n-1"]


@settings(deadline=None)
@given(FRAMES, st.integers(1, 99))
def test_a_mean_moved_off_the_grain_fails(frames, part):
    n = len(frames)
    off = Fraction(sum(frames), 100 * n) + Fraction(part, 100) * Fraction(1, 100 * n)
    mean = decimals.fixed(off, 9)
    assert audit.grim(mean, n, "0.01").verdict == "inconsistent"
    assert audit.grimmer(mean, "0.1", n, "0.01").verdict == "inconsistent"


@settings(max_examples=50, deadline=None)
@given(FRAMES)
def test_an_sd_that_no_sample_has_fails(frames):
    mean, _ = printed(frames, 8)
    n, total = len(frames), sum(frames)
    # Between two neighbouring sums of squares of the right parity there is no sample.
    squares = sum(f * f for f in frames) + 1
    ss = Fraction(squares) - Fraction(total * total, n)
    sd = decimals.fixed_root(ss / (n - 1) / 10_000, 9)
    assert audit.grimmer(mean, sd, n, "0.01", divisor="n-1").verdict == "inconsistent"


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(10, 50), min_size=3, max_size=7))
def test_samples_print_as_the_row(frames):
    mean, sd = printed(frames, 6)
    found = audit.samples(mean, sd, len(frames), "0.01", "0.10", "0.50", most=20)
    assert found.values
    for sample in found.values:
        assert printed(sample, 6) == (mean, sd)
        assert 10 <= min(sample) <= max(sample) <= 50
    if found.complete:
        assert tuple(sorted(frames)) in found.values


def test_large_samples_are_decided_too():
    rng = np.random.default_rng(1)
    frames = rng.integers(10, 60, 400).tolist()
    mean, sd = printed(frames, 6)
    found = audit.grimmer(mean, sd, 400, "0.01", "n-1")
    assert (sum(frames), sum(f * f for f in frames)) in found.pairs["n-1"]


def test_grim_says_where_it_cannot_tell():
    found = audit.grim("0.303", 89, "0.01")
    assert found.verdict == "undecidable"
    assert "every mean" in found.why


# --- summaries


GROUPS = st.lists(
    st.lists(st.integers(5, 90), min_size=2, max_size=9).filter(lambda v: len(set(v)) > 1),
    min_size=2, max_size=5,
)  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(GROUPS, st.integers(3, 6))
def test_what_rounding_allows_holds_what_the_data_give(data, places):
    rows = [(len(v), *printed(v, places)) for v in data]
    test = audit.anova_from_summary(*zip(*rows, strict=True))
    values = [np.array(v) / 100 for v in data]
    everything = np.concatenate(values)
    within = sum(((v - v.mean()) ** 2).sum() for v in values)
    between = ((everything - everything.mean()) ** 2).sum() - within
    f = (between / (len(data) - 1)) / (within / (len(everything) - len(data)))
    slack = 1e-9 * max(1, f)
    assert test.statistic.low - slack <= f <= test.statistic.high + slack
    of = summaries.groups(*zip(*rows, strict=True))
    total = summaries.pooled_sd(of)
    assert total.low - 1e-9 <= everything.std(ddof=1) <= total.high + 1e-9
    mean = summaries.pooled_mean(of)
    assert Fraction(sum(sum(v) for v in data), 100 * len(everything)) in mean


@settings(deadline=None)
@given(st.lists(st.sampled_from("abc"), min_size=2, max_size=30), st.integers(0, 4))
def test_chains_never_outnumber_those_there_were(signs, cuts):
    bounds = sorted({0, len(signs), *[(i + 1) * len(signs) // (cuts + 1) for i in range(cuts)]})
    pieces = [signs[a:b] for a, b in pairwise(bounds)]
    counts = {}
    for piece in pieces:
        for a, b in pairwise(piece):
            counts[a + b] = counts.get(a + b, 0) + 1
    least, _ = audit.chains(counts, digits=1)
    assert least <= sum(len(p) > 1 for p in pieces)
    assert (least == 0) == (not counts)


def test_p_disagreements_are_told():
    assert audit.p_agrees("F", "4.20", (1, 50), "<0.05").verdict == "consistent"
    wrong = audit.p_agrees("F", "4.20", (1, 50), "0.20")
    assert wrong.verdict == "inconsistent"
    assert "disagree about 0.05" in wrong.why
    assert audit.p_agrees("H", "40.0", (7,), "<1e-7").verdict == "inconsistent"


def test_the_smallest_effect_has_its_power():
    n = [6, 7, 5, 9, 9, 11]
    assert audit.power_of(n, audit.smallest_effect(n, 0.8)) == pytest.approx(0.8, abs=1e-8)


def test_one_contradiction_decides():
    a, b, c = (audit.grim(m, 6, "0.01") for m in ("0.26833", "0.26834", "0.3"))
    assert (a.verdict, b.verdict, c.verdict) == ("consistent", "inconsistent", "undecidable")
    assert summary([a, b, c]) == "inconsistent"
    assert summary([a, c]) == "consistent"
    assert summary([c]) == "undecidable"


# --- bad input


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda: audit.grim("0,268", 6), r"'0,268' is no number; expected digits with a decimal"),
        (lambda: audit.grim("0.268", 0), r"n is '0'; expected a whole number from 1"),
        (lambda: audit.grim("0.268", "2.5"), r"n is '2.5'; expected a whole number from 1"),
        (lambda: audit.grim(0.268, 6), r"is no text; expected the printed digits in quotes"),
        (lambda: audit.grim("0.268", 6, "0"), r"the grain is 0; expected a step above 0"),
        (lambda: audit.grim("0.268", 6, rounding="up"), r"the rounding 'up'; expected nearest"),
        (lambda: audit.grimmer("0.3", "0.1", 5, divisor="n+1"), r"the divisor 'n\+1'"),
        (lambda: audit.anova_from_summary([1, 4], ["1.0", "2.0"], ["0.2", "0.3"]),
         r"the SD 0.2 of a single value; expected 0, or an empty cell"),
        (lambda: audit.anova_from_summary([4], ["1.0"], ["0.2"]), r"1 groups with 4 values"),
        (lambda: audit.p_from("F", "2.0", 3), r"degrees of freedom \[3\] for F; expected 2"),
        (lambda: audit.p_from("q", "2.0", 3), r"the statistic 'q'; expected F, t, chi2"),
    ],
)  # fmt: skip
def test_bad_numbers_are_one_sentence(call, sentence):
    with pytest.raises(SignkinError, match=sentence):
        call()


def test_shown_is_short():
    assert shown(Fraction(413, 1600)) == "0.258125"
