from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import decimals
from signkin.statistics.descriptive import (
    TYPES,
    diamond,
    hand_change,
    hand_changes,
    outliers,
    table2,
    trend,
)


@pytest.fixture(scope="session")
def published(root):
    return pd.read_csv(root / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False)


# --- printing


def test_half_is_rounded_up_where_binary_numbers_cannot_tell():
    frames = [26] * 15 + [23]  # 413 frames over 16 transitions
    mean = decimals.mean([decimals.exact(f / 100) for f in frames])
    assert mean == Fraction(413, 1600)
    assert decimals.fixed(mean, 5) == "0.25813"
    assert decimals.fixed(Fraction(1, 8), 2) == "0.13"


@given(st.lists(st.integers(1, 100), min_size=2, max_size=20), st.integers(1, 8))
def test_means_and_sds_print_as_exact_arithmetic_says(frames, places):
    values = [decimals.exact(f / 100) for f in frames]
    unit = Decimal(1).scaleb(-places)
    exact_mean = Decimal(sum(frames)) / Decimal(100 * len(frames))
    if Fraction(sum(frames), len(frames)).denominator in (1, 2, 4, 5, 8, 10, 16, 20):
        expected = exact_mean.quantize(unit, rounding=ROUND_HALF_UP)
        assert decimals.fixed(decimals.mean(values), places) == str(expected)
    sd = np.std(np.array(frames) / 100, ddof=1)
    assert float(decimals.fixed_root(decimals.variance(values), 12)) == pytest.approx(sd, abs=1e-9)


def test_decimals_of_a_print():
    assert decimals.places_of("0.3150") == 4
    assert decimals.places_of("7") == 0
    assert [decimals.places_for(v) for v in (0.26833, 0.095167, 12.3, 0.0, 99999.6)] == [
        5,
        6,
        3,
        0,
        0,
    ]


# --- Table 2


def rows(**durations):
    pairs = [(kind.lstrip("t"), d) for kind, ds in durations.items() for d in ds]
    return pd.DataFrame(pairs, columns=["type", "duration_s"])


def test_a_row_is_printed_as_the_paper_prints_it(published):
    frames = [11, 24, 26, 30, 30, 40]
    table = rows(t0000=[f / 100 for f in frames])
    found = table2(table, np.zeros(6, dtype=bool), published).set_index("type")
    row = found.loc["0000"]
    assert row[["printed_n", "printed_mean", "printed_sd"]].tolist() == ["6", "0.26833", "0.095167"]
    assert row["equal"] == "yes"
    assert found.loc["1000", "equal"] == "no"
    assert found.loc["0020", ["printed_mean", "equal"]].tolist() == ["/", "yes"]


def test_outliers_stand_in_brackets_with_the_papers_digits(published):
    frames = [26, 29, 29, 29, 31, 34, 36, 38, 79]
    flags = np.array([f == 79 for f in frames])
    found = table2(rows(t1000=[f / 100 for f in frames]), flags, published).set_index("type")
    row = found.loc["1000"]
    assert row["printed_n"] == "9 (8)"
    assert row["printed_mean"] == "0.36778 (0.3150)"
    assert row["printed_sd"] == "0.16292 (0.041057)"
    assert row["equal"] == "yes"


def test_one_value_has_no_sd_and_says_so(published):
    found = table2(rows(t2010=[0.3]), np.zeros(1, dtype=bool), published).set_index("type")
    assert np.isnan(found.loc["2010", "sd_s"])
    assert found.loc["2010", "printed_sd"] == "0"
    assert "undefined" in found.loc["2010", "note"]
    assert found.loc["2010", "equal"] == "yes"


def test_the_papers_zero_for_one_value_sets_no_decimals(published):
    """Type 2010 has one value in the paper and SD 0 in print; two values have an SD of 0.119."""
    times = [0.3, 0.468]
    found = table2(rows(t2010=times), np.zeros(2, dtype=bool), published).set_index("type")
    assert found.loc["2010", "printed_sd"] == "0.11879"
    assert float(found.loc["2010", "printed_sd"]) == pytest.approx(np.std(times, ddof=1), abs=5e-6)
    assert found.loc["2010", "printed_mean"] == "0.38400"


def test_moving_one_tag_changes_one_row(published):
    base = rows(t0000=[0.11, 0.24, 0.26, 0.30, 0.30, 0.40], t1100=[0.21, 0.28, 0.34, 0.39])
    moved = base.copy()
    moved.loc[7, "duration_s"] += 0.01
    none = np.zeros(10, dtype=bool)
    a, b = (table2(t, none, published).set_index("type").drop(index="all") for t in (base, moved))
    changed = a[a["printed_mean"] != b["printed_mean"]].index.tolist()
    assert changed == ["1100"]
    assert b.loc["1100", "equal"] == "no"


def test_the_published_table_has_every_type_and_89_transitions(published):
    assert tuple(published["type"]) == TYPES
    assert published["n"].astype(int).sum() == 89


def test_outliers_by_tukeys_far_fences():
    values = np.array([0.2, 0.25, 0.3, 0.35, 0.4, 0.79])
    assert outliers(values, 1.5).tolist() == [False] * 5 + [True]
    assert not outliers(values, 5).any()
    assert outliers(np.empty(0), 3).tolist() == []


# --- Fig. 8


def inside(corners, x, y):
    """Return whether points lie in the convex polygon of the corners, by cross products."""
    names = ("left", "top", "right", "bottom")
    ring = np.array([corners[n] for n in names])
    held = np.ones(len(x), dtype=bool)
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        cross = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
        held &= cross <= 1e-9
    return held


def area(corners):
    ring = np.array([corners[n] for n in ("left", "top", "right", "bottom")])
    x, y = ring[:, 0], ring[:, 1]
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


@settings(max_examples=30, deadline=None)
@given(st.integers(5, 40), st.integers(0, 10_000), st.sampled_from([0.5, 0.8, 0.9]))
def test_the_diamond_holds_more_than_its_share_and_none_smaller_does(n, seed, share):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=n)
    y = 0.3 * x + 0.1 * rng.normal(size=n)
    found = diamond(x, y, share)
    assert found.share > share or found.inside.all()
    assert (inside(found.corners, x, y) == found.inside).all()
    # Brute force: every box whose sides go through points.
    scale = [np.subtract(*np.quantile(v, [0.75, 0.25])) for v in (x, y)]
    u, v = x / scale[0] + y / scale[1], x / scale[0] - y / scale[1]
    needed = int(np.floor(share * n)) + 1
    best = np.inf
    for u0 in u:
        for u1 in u[u >= u0]:
            kept = np.sort(v[(u >= u0) & (u <= u1)])
            if len(kept) >= needed:
                width = (kept[needed - 1 :] - kept[: len(kept) - needed + 1]).min()
                best = min(best, (u1 - u0) * width)
    assert area(found.corners) == pytest.approx(best * scale[0] * scale[1] / 2, rel=1e-9)


# --- Fig. 10


def test_changes_of_hands():
    assert [hand_change(k) for k in ("0000", "0020", "1100", "2011")] == [
        "1H to 1H", "1H to 2H", "2H to 1H", "2H to 2H",
    ]  # fmt: skip


def test_the_papers_means_follow_from_its_table(published):
    found = hand_changes(rows(t0000=[0.2, 0.4], t1111=[0.3]), published).set_index("change")
    assert found["published_n"].tolist() == [6, 12, 13, 58]
    # From the unique sums in frames that the print allows, by type.
    assert found["published_mean_s"].tolist() == pytest.approx(
        [161 / 600, 377 / 1200, 453 / 1300, 1706 / 5800], abs=5e-6
    )
    assert found.loc["1H to 1H", "mean_s"] == pytest.approx(0.3)
    assert found.loc["1H to 2H", "n"] == 0
    assert np.isnan(found.loc["1H to 2H", "mean_s"])


def test_a_trend_needs_variation():
    line = trend(np.array([0.0, 1, 2]), np.array([1.0, 3, 5]))
    assert (line.slope, line.intercept, line.r) == pytest.approx((2, 1, 1))
    assert trend(np.zeros(5), np.arange(5.0)) is None
