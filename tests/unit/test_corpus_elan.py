"""ELAN files with a tier `check`: what to look at stands where it is, and ELAN can open them."""

import pandas as pd
import pytest

from signkin import read_annotation
from signkin.annotation import Interval
from signkin.io.eaf_write import new_eaf
from signkin.pages.corpus_elan import MOST_FILES, Looked, with_check_tier, write_check_files
from support.elan_rules import broken

ROWS = pd.DataFrame(
    [
        ("r", "recording", 1, None, None, "", "much is missing & <odd>"),
        ("r", "tag", 2, 1.0, 1.6, "CAT\x07", "its start lies far"),
        ("r", "tag", 2, 1.0, 1.6, "CAT\x07", "its end lies far"),
        ("r", "transition", 2, 1.5, 1.7, "CAT → DOG", "the signs overlap"),
        ("r", "transition", 3, 4.0, 4.0, "DOG → CAT", "of no length"),
        ("r", "tag", 4, 5.0, 5.5, "DOG", "rated ok"),
    ],
    columns=["recording", "what", "rank", "start_s", "end_s", "gloss", "why"],
)


def original(path, name="sign"):
    signs = [Interval(1.0, 1.6, "CAT", name), Interval(2.0, 2.5, "DOG", name)]
    path.write_bytes(
        new_eaf(author="me", date="2020-01-01T00:00:00+00:00", media_url="v.mp4",
                tiers=[(name, None, signs)])
    )  # fmt: skip
    return path


def tiers_of(content, path):
    path.write_bytes(content)
    assert broken(content) == []
    read = read_annotation(path)
    names = dict.fromkeys(one.tier for one in read.intervals)
    return {name: [(i.start_s, i.end_s, i.label) for i in read.tier(name)] for name in names}


def test_each_row_is_an_annotation_at_its_place_and_the_users_tiers_stay(tmp_path):
    file = original(tmp_path / "o.eaf")
    found = tiers_of(with_check_tier(ROWS[:5], Looked(9.0, "v.mp4", file)), tmp_path / "c.eaf")
    assert found["sign"] == [(1.0, 1.6, "CAT"), (2.0, 2.5, "DOG")]
    assert found["check"] == [
        (1.0, 1.6, "tag CAT : its start lies far; tag CAT : its end lies far"),
        (4.0, 4.001, "transition DOG → CAT: of no length"),
    ]
    assert found["check (2)"] == [(1.5, 1.7, "transition CAT → DOG: the signs overlap")]
    assert found["check (3)"] == [(0.0, 9.0, "recording: much is missing & <odd>")]


def test_clocks_that_differ_and_tiers_of_that_name_are_respected(tmp_path):
    file = original(tmp_path / "o.eaf", name="check")
    looked = Looked(9.0, "v.mp4", file, clock_offset_s=0.5)
    found = tiers_of(with_check_tier(ROWS[1:2], looked), tmp_path / "c.eaf")
    assert found["check"] == [(1.0, 1.6, "CAT"), (2.0, 2.5, "DOG")]
    assert found["signkin check"] == [(0.5, 1.1, "tag CAT : its start lies far")]


def test_without_tags_the_file_has_this_tier_alone_and_made_twice_the_same_bytes(tmp_path):
    looked = Looked(9.0, "m.bvh", None)
    once = with_check_tier(ROWS[:1], looked)
    assert tiers_of(once, tmp_path / "c.eaf") == {
        "check": [(0.0, 9.0, "recording: much is missing & <odd>")]
    }
    assert once == with_check_tier(ROWS[:1], looked)


@pytest.mark.parametrize("many", [1, 700])
def test_recordings_of_the_list_get_a_file_but_what_is_rated_ok_does_not(tmp_path, many):
    names = [f"{'n' * 180}{i}" for i in range(many)]
    todo = pd.concat([ROWS[:2].assign(recording=name) for name in names])
    todo = pd.concat([todo, ROWS[5:].assign(recording="fine")])
    looked = {name: Looked(9.0, "m", None) for name in [*names, "fine"]}
    files = write_check_files(todo, looked, tmp_path / "check")
    assert list(files) == names[:MOST_FILES]
    assert sorted(p.name for p in (tmp_path / "check").iterdir()) == sorted(
        f"{name}.eaf" for name in files
    )
