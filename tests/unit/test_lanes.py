"""Eight numbers at a time do what one does."""

import numpy as np
import pytest

from signkin.binning import lanes
from signkin.binning.lanes import (
    any_above,
    exp_in_place,
    larger,
    load,
    log,
    moved_up,
    splat,
    store,
    total,
    transpose,
    where_above,
)
from signkin.binning.room import MOST_KEPT, Room
from signkin.binning.stale import STAMP, forget_stale
from signkin.jit import helper, kernel

A = np.array([1.5, -2.0, 0.0, 1e300, -1e-300, np.inf, 3.0, 7.25])
B = np.array([0.5, 4.0, -1.0, 2.0, 3.0, 1.0, 3.0, -0.125])


@kernel  # no division by zero or overflow is an error
def arithmetic(a, b, out):
    x, y = load(a, (0,)), load(b, (0,))
    store(out, (0, 0), x + y)
    store(out, (1, 0), x - y)
    store(out, (2, 0), x * y)
    store(out, (3, 0), x / y)
    store(out, (4, 0), 2.0 * x - y / 3.0)
    store(out, (5, 0), larger(x, y))
    store(out, (6, 0), where_above(x, y, x, splat(-9.0)))
    store(out, (7, 0), moved_up(x))


def test_signs_work_on_each_lane():
    out = np.empty((8, 8))
    arithmetic(A, B, out)
    with np.errstate(over="ignore"):
        expected = [A + B, A - B, A * B, A / B, 2.0 * A - B / 3.0, np.maximum(A, B)]
    expected += [np.where(A > B, A, -9.0), np.concatenate([[0.0], A[:-1]])]
    np.testing.assert_array_equal(out, expected)


@helper
def of_all(a, limit):
    return total(load(a, (0,))), any_above(load(a, (0,)), splat(limit))


def test_lanes_are_added_by_halves_and_compared():
    rng = np.random.default_rng(1)
    a = rng.normal(size=8) * 10.0 ** rng.integers(-8, 8, 8)
    quarters = a[:4] + a[4:]
    halves = quarters[:2] + quarters[2:]
    assert of_all(a, a.max())[0] == halves[0] + halves[1]
    assert [of_all(a, limit)[1] for limit in (a.max(), np.nextafter(a.max(), -9))] == [False, True]
    assert not of_all(np.full(8, np.nan), 0.0)[1]


@helper
def turn(source, target):
    transpose(source, (8, 0), target, (1, 0, 0))


def test_rows_become_columns():
    source, target = np.arange(128.0).reshape(16, 8), np.zeros((2, 8, 8))
    turn(source, target)
    np.testing.assert_array_equal(target, [np.zeros((8, 8)), source[8:].T])


@helper
def logs(values):
    for i in range(0, len(values), 8):
        store(values, (i,), log(load(values, (i,))))


def test_logs_are_those_of_the_library_to_a_bit():
    rng = np.random.default_rng(2)
    near_one = 1.0 + np.concatenate([10.0 ** -np.arange(1.0, 17), -(10.0 ** -np.arange(1.0, 17))])
    values = np.concatenate(
        [np.exp(rng.uniform(-700, 700, 4000)), near_one, [1.0, 2.0, 0.5, 1e307]]
    )
    values = np.resize(values, 8 * -(-len(values) // 8))
    found = values.copy()
    logs(found)
    np.testing.assert_array_max_ulp(found, np.log(values), 1)


def test_exponentials_are_those_of_the_library_to_a_bit_and_end_at_zero():
    rng = np.random.default_rng(3)
    values = np.concatenate([rng.uniform(-345, 0, 4000), -(10.0 ** -np.arange(1.0, 17)), [0.0]])
    found = np.append(values, np.zeros(16))
    exp_in_place(found, len(values))
    np.testing.assert_array_max_ulp(found[: len(values)], np.exp(values), 1)
    far = np.array([lanes.LEAST_EXPONENT, -345.1, -1e4, -1e300, -np.inf, np.nan, -400.0, -700.0])
    exp_in_place(far, 8)
    np.testing.assert_array_equal(far, np.zeros(8))


@pytest.mark.parametrize("size", [1, 7, 64, 1001])
@pytest.mark.parametrize("make", [lanes.aligned, lanes.new_aligned])
def test_arrays_start_on_a_line_of_the_cache(make, size):
    assert make(size).shape == (size,)
    assert make(size).ctypes.data % 64 == 0


def test_memory_is_kept_by_name_and_not_when_there_is_much_of_it():
    room = Room()
    first = room.array("a", 10, 8)
    assert room.array("a", 5, 8).base is first.base
    assert not np.shares_memory(room.array("b", 5, 8), first)
    assert room.array("a", 10, 10).shape == (10, 10)
    large = room.array("a", MOST_KEPT + 1)
    assert not np.shares_memory(room.array("a", 4), large)


def test_compiled_code_is_forgotten_when_a_source_changes(tmp_path):
    folder, source = tmp_path / "cache", tmp_path / "kernels.py"
    source.write_text("old")
    assert forget_stale(folder, [source])
    kept = [folder / "kernels.f-1.py311.nbi", folder / "kernels.f-1.py311.1.nbc"]
    others = [folder / "other.f-1.py311.nbi", folder / "kernels.cpython-311.pyc"]
    for file in [*kept, *others]:
        file.write_text("code")
    assert not forget_stale(folder, [source])
    assert all(file.exists() for file in kept)
    source.write_text("new")
    assert forget_stale(folder, [source])
    assert not any(file.exists() for file in kept)
    assert all(file.exists() for file in others)
    assert sorted(file.name for file in folder.iterdir()) == sorted(
        [STAMP, *(file.name for file in others)]
    )


def test_a_folder_that_cannot_be_made_is_left_alone(tmp_path):
    source = tmp_path / "kernels.py"
    source.write_text("old")
    assert not forget_stale(source / "cache", [source])
