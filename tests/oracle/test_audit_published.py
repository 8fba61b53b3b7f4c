"""Published cases, possible and impossible, as numbers with their source.

Each is a mean, an SD or nothing, n, and answers per value; what exists is what brute force over
whole numbers says (where a source says otherwise, it is named).
"""

import pytest

from signkin.audit import grim, grimmer

MEANS = [
    ("scrutiny, documents", "5.19", 28, 1, False),
    ("Wikipedia, GRIM test", "3.48", 20, 1, False),
    ("scrutiny, pigs1", "7.22", 32, 1, True),
    ("scrutiny, pigs1", "2.68", 28, 1, True),
    ("scrutiny, pigs1", "0.24", 28, 1, False),
    ("scrutiny, vignette, three items", "3.82", 40, 3, True),
    ("scrutiny, tests, three items", "0.156", 120, 3, True),
    ("scrutiny, tests, three items", "0.154", 120, 3, False),
]
SDS = [
    ("scrutiny, pigs5", "3.14", "5.32", 33, 1, False),
    ("scrutiny, pigs5", "2.68", "2.59", 34, 1, True),
    ("scrutiny, pigs5", "5.00", "2.18", 31, 1, True),
    ("scrutiny, pigs5", "7.22", "5.30", 38, 1, False),
    ("scrutiny, documents", "5.23", "2.55", 35, 1, False),
    ("scrutiny, documents", "7.3", "2.51", 12, 1, False),
    ("scrutiny, documents, two items", "2.74", "0.96", 63, 2, True),
    ("rsprite2, documents", "5.19", "1.5", 28, 1, False),
    ("rsprite2, documents", "5.21", "1.6", 28, 1, True),
    ("rsprite2, tests", "3.33", "1.234", 250, 1, True),
    ("INSPECT-SR, item 4.8", "9.93", "0.18", 30, 1, False),
    # A-GRIMMER accuses these four wrongly (its third test).
    ("scrutiny, issue on GRIMMER", "16.03", "6.41", 40, 1, True),
    ("scrutiny, issue on GRIMMER", "64.73", "25.89", 40, 1, True),
    ("scrutiny, issue on GRIMMER", "512.33", "204.93", 80, 1, True),
    ("scrutiny, issue on GRIMMER", "16.22", "6.49", 80, 1, True),
]
SHARES = [
    ("scrutiny, pigs3", "0.34", "0.47", 1683, True),
    ("scrutiny, pigs3", "0.93", "0.25", 1683, True),
    ("scrutiny, pigs3", "0.19", "0.35", 1683, False),
    ("scrutiny, vignette on DEBIT", "0.35", "0.18", 20, False),
]


@pytest.mark.parametrize("source, mean, n, items, exists", MEANS)
def test_published_means(source, mean, n, items, exists):
    assert (grim(mean, n, "1", items=items).verdict != "inconsistent") == exists, source


@pytest.mark.parametrize("source, mean, sd, n, items, exists", SDS)
def test_published_sds(source, mean, sd, n, items, exists):
    found = grimmer(mean, sd, n, divisor="n-1", items=items)
    assert (found.verdict != "inconsistent") == exists, source


@pytest.mark.parametrize("source, mean, sd, n, exists", SHARES)
def test_published_shares(source, mean, sd, n, exists):
    found = grimmer(mean, sd, n, low="0", high="1")
    assert (found.verdict != "inconsistent") == exists, source


def test_three_item_means_are_thirds():
    # 0.33 is a third: a grain of 0.33 would accuse what exists.
    assert grim("2.67", 1, "1/3").verdict == "consistent"
    assert grim("2.67", 1, items=3).verdict == "consistent"
    assert grim("2.67", 1, "0.33").verdict == "inconsistent"
    assert grimmer("3.44", "2.47", 18, items=3).verdict == "consistent"
    assert grimmer("3.44", "2.47", 18).verdict == "inconsistent"


def test_a_single_value_off_the_grain_is_told():
    assert grimmer("3.50", "0", 1).verdict == "inconsistent"
    assert grimmer("3.00", "0", 1).verdict == "undecidable"
    assert grimmer("3.00", "0.5", 1).verdict == "inconsistent"
