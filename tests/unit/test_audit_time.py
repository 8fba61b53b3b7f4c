"""No check takes long: bounded searches, at any n, on any print."""

import csv
import shutil
import time

import pytest

from signkin.audit import grimmer
from signkin.audit.commands import findings_of
from signkin.audit.ledger import audit
from signkin.audit.paper import read_paper
from signkin.audit.registry import PUBLISHED
from signkin.audit.whole import possible
from tools import audit_time

MOST = 1.5  # seconds of processor time; under one on a machine of its own


def took(call):
    start = time.process_time()
    call()
    return time.process_time() - start


@pytest.mark.parametrize("n", ["10", "89", "10000"])
@pytest.mark.parametrize(
    "mean, sd, grain",
    [("562", "87", "1"), ("0.30", "0.10", "0.01"), ("3.21", "1.99", "1"), ("100", "0.00", "1/7"),
     ("12.345", "3.456", "0.1"), ("3.2", "0.7", "0.1")],
)  # fmt: skip
def test_means_and_sds_take_a_second(tmp_path, n, mean, sd, grain):
    given = {"mean": mean, "sd": sd, "n": n, "grain": grain}
    for scale in ({}, {"low": "0", "high": "1000"}, {"low": "0"}, {"high": "1000"}):
        every = {**given, **scale, "divisor": "either", "spread": "either"}
        assert took(lambda every=every: findings_of("grimmer", every, tmp_path)) < MOST
    bounds = {**given, "low": "0", "high": "1000"}
    assert took(lambda: findings_of("range_possible", bounds, tmp_path)) < MOST


@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_every_check_takes_a_second_at_every_size(tmp_path, name):
    for n in audit_time.SIZES if name in audit_time.CALLS else (10,):
        assert audit_time.took(name, n, tmp_path) < MOST


@pytest.mark.parametrize("n", ["10", "1000", "10000"])
def test_tests_of_groups_take_a_second(tmp_path, n):
    given = {"n": [n] * 6, "mean": ["5.1", "4.2", "3.3"] * 2, "sd": ["1.5", "1.4", "1.1"] * 2}
    call = {**given, "F": "99", "p": ".5", "spread": "either"}
    assert took(lambda: findings_of("test_of_groups", call, tmp_path)) < MOST


def test_the_exact_kruskal_wallis_gives_up_in_time(tmp_path):
    for groups in (["8", "8", "8"], ["5"] * 5, ["2"] * 12, ["12", "13"]):
        given = {"groups": groups, "p": "<.001"}
        assert took(lambda given=given: findings_of("p_reachable", given, tmp_path)) < MOST


def test_what_is_too_much_to_try_is_undecidable():
    # Cut off: nothing is accused that was not tried to its end.
    found = grimmer("3.21", "1.99", 10000, "0.1", low="1", high="5", divisor="n-1")
    assert found.verdict in ("consistent", "undecidable")
    found = grimmer("0.3", "0.0", 10**9, "0.000001")
    assert found.verdict in ("consistent", "undecidable")


def test_three_rounded_cells_do_not_hang_the_audit(root, tmp_path):
    folder = tmp_path / "naert2017"
    shutil.copytree(root / "papers/naert2017", folder)
    with (folder / "table2.csv").open() as file:
        rows = list(csv.DictReader(file))
    for row, (mean, sd) in zip(rows[4:7], (("0.4", "0.2"), ("0.3", "0.1"), ("0.3", "0.1")),
                               strict=True):  # fmt: skip
        row["mean"], row["sd"] = mean, sd
    with (folder / "table2.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    assert took(lambda: audit([read_paper(folder)])) < 15


@pytest.mark.parametrize("n", [16, 17, 30, 61, 200, 5000])
def test_sixteen_numbers_have_every_sum_of_squares(n):
    for total in (0, 1, n // 2, n - 1, 7 * n + 3):
        low, ones = divmod(total, n)
        least = (n - ones) * low * low + ones * (low + 1) ** 2
        assert possible(n, total, least)
        assert possible(n, total, least + 2)
        assert possible(n, total, least + 1) is False
        assert possible(n, total, least - 2) is False
        assert possible(n, total, least + 2 * n * n + 14)
