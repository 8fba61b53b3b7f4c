"""What the pages of recordings hold: packed series, time lines, choice, bad input."""

import json
import re
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from signkin.binning import fit
from signkin.explorer.choice import chosen
from signkin.explorer.content import as_json
from signkin.explorer.events import Labels, flags, minima
from signkin.explorer.packing import packed, unpacked, weight
from signkin.explorer.pages import write_pages
from signkin.explorer.skeleton import flat, skeleton
from signkin.explorer.sources import Sources
from signkin.settings import Settings
from signkin.studies.endres2013.posteriors import prior_of
from signkin.studies.one_wrist.long_series import wrist_in_bins
from signkin.studies.one_wrist.settings import SeriesSettings
from support.explorer_pages import HOSTILE, made_up, signer

SIGNS = [(0.5, 1.0, "CAT"), (1.4, 2.0, HOSTILE), (2.5, 3.0, "DOG"), (2.9, 3.6, "L" * 200)]


def content_of(folder, name="one"):
    html = (folder / "pages" / f"{name}.html").read_text(encoding="utf-8")
    text = re.search(r'<script type="application/json" id="data">(.*?)</script>', html, re.DOTALL)
    return html, json.loads(text[1])


def pages_of(folder, recordings, signs=(), **more):
    sources = made_up(folder / "made", recordings, signs, **more)
    write_pages(sources, folder / "pages", folder / "pages.html")
    return content_of(folder, recordings[0].name)


# --- packing ---------------------------------------------------------------------------------


def test_a_packed_series_comes_back_to_half_a_step_and_gaps_stay():
    rng = np.random.default_rng(2)
    series = np.cumsum(rng.normal(0, 0.02, (500, 3)), axis=0)
    series += np.array([5.0, -200.0, 0.0])
    series[40:60, 1] = np.nan
    series[0, 0] = np.nan
    back = unpacked(packed(series, 0.001))
    assert np.array_equal(np.isnan(back), np.isnan(series))
    assert np.nanmax(np.abs(back - series)) <= 0.0005 * (1 + 1e-6)


def test_a_range_too_wide_for_sixteen_bits_takes_larger_steps():
    series = np.array([[0.0], [1e6], [np.nan], [5e5]])
    pack = packed(series, 0.001)
    assert pack["step"] == pytest.approx(1e6 / 64_000)
    assert np.nanmax(np.abs(unpacked(pack) - series)) <= pack["step"] / 2 * (1 + 1e-6)


@pytest.mark.parametrize("series", [np.full((5, 2), np.nan), np.empty((0, 2)), np.zeros((1, 1))])
def test_a_series_with_nothing_in_it_is_packed_in_silence(series):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        back = unpacked(packed(series, 0.01))
    assert back.shape == series.shape
    assert np.array_equal(np.isnan(back), np.isnan(series))


# --- skeleton --------------------------------------------------------------------------------


def test_a_short_recording_keeps_every_joint_at_no_more_than_sixty_frames_a_second():
    recording = signer(seconds=4, rate_hz=240)
    body = skeleton(recording, 10**6)
    assert body["rate"] == 60
    assert tuple(body["joints"]) == recording.joints
    back = unpacked(body["positions"]).reshape(-1, len(recording.joints), 3)
    assert np.abs(back - recording.positions[::4]).max() <= body["positions"]["step"] / 2 * 1.001
    assert not body["flat"] and not body["handsOnly"] and body["told"] == ""


def test_a_long_recording_loses_inner_fingers_before_frames_and_stays_within_its_bytes():
    recording = signer(seconds=30)
    whole = weight(skeleton(recording, 10**7)["positions"])
    body = skeleton(recording, whole // 5)
    assert weight(body["positions"]) <= whole // 5
    assert "right_index_1" not in body["joints"] and "right_wrist" in body["joints"]
    assert "for the length of it" in body["told"]
    tiny = skeleton(recording, whole // 60)
    assert weight(tiny["positions"]) <= whole // 60
    assert tiny["rate"] < body["rate"]
    assert all(joint in tiny["joints"] for joint in ("right_wrist", "left_wrist", "head"))


def test_a_recording_in_one_upright_plane_is_flat():
    assert flat(signer(flat=True).positions)
    assert not flat(signer().positions)


# --- time line -------------------------------------------------------------------------------


def test_minima_are_told_by_their_distances(tmp_path):
    sources = made_up(tmp_path, [signer()])
    told = minima(sources.of("minima", "one"))
    rows = sources.of("minima", "one")
    right = np.cumsum(told["right"]) / 1000
    assert right == pytest.approx(rows.loc[rows["hand"] == "right", "minimum_s"], abs=6e-4)
    assert len(told["right"]) > 3


def test_gaps_tell_what_was_filled_and_what_stays(tmp_path):
    recording = signer()
    recording.positions[50:53, 5] = np.nan  # 0.06 s: filled
    recording.positions[100:125, 5] = np.nan  # 0.5 s: stays
    _, data = pages_of(tmp_path, [recording])
    assert data["gaps"]["right"] == [[1000, 1040, 1], [2000, 2480, 0]]
    assert data["gaps"]["left"] == []
    assert [flag["at"] for flag in data["flags"]] == [2000]
    speed = unpacked(data["speeds"]["values"])
    assert np.isnan(speed[110, 0]) and np.isfinite(speed[110, 1])


def test_flags_tell_where_to_look_in_order_of_time():
    data = {
        "refined": {
            "right": [[0, 0, 500, "f", 2], [0, 1, 900, "m", 80], [1, 0, 1500, "m", 1]],
            "left": [[0, 0, 500, "f", 60], [0, 1, 880, "f", 70], [1, 0, 1500, "f", 99]],
        },
        "transitions": [
            {"number": 1, "manual": [900, 800], "status": "overlap", "outlier": False},
            {"number": 2, "manual": [2000, 3500], "status": "ok", "outlier": True},
        ],
        "gaps": {"right": [[100, 400, 0], [600, 640, 1]]},
    }  # fmt: skip
    found = flags(data)
    assert [flag["at"] for flag in found] == [100, 500, 880, 900, 2000]
    told = " | ".join(flag["why"] for flag in found)
    assert "right wrist: no position for 0.30 s" in told
    assert "start of sign 1: no speed minimum of either hand near" in told
    assert "end of sign 1: more than 0.1 s from its boundary, probability 70 %" in told
    assert "transition 1: the signs overlap" in told
    assert "transition 2: an outlier, 1.50 s" in told
    assert "sign 2" not in told  # one hand has its minimum


def test_labels_are_held_once():
    labels = Labels()
    assert [labels.place(text) for text in ("A", "B", "A", float("nan"), "")] == [0, 1, 0, 2, 2]


# --- pages -----------------------------------------------------------------------------------


def test_a_page_holds_tags_refined_tags_transitions_and_syntheses(tmp_path):
    _, data = pages_of(tmp_path, [signer()], SIGNS)
    assert [tag[:2] for tag in data["lanes"][0]["tags"]] == [
        [500, 1000], [1400, 2000], [2500, 3000], [2900, 3600]
    ]  # fmt: skip
    fields = data["transitions"]["fields"]
    rows = [dict(zip(fields, row, strict=True)) for row in data["transitions"]["rows"]]
    assert [row["status"] for row in rows] == ["ok", "ok", "overlap"]
    assert rows[0]["right"] == [1020, 1400]
    assert any("no speed minimum of either hand near" in f["why"] for f in data["flags"])
    made = data["syntheses"]["methods"]
    assert set(made) == {"interpolation", "blending"}
    first, frames, length = made["interpolation"]["frames"][0]
    assert (first, length) == (1, 0.3)
    path = unpacked(made["interpolation"]["positions"])
    joints = data["skeleton"]["joints"]
    wrist = 3 * joints.index("right_wrist")
    before = signer().positions[50, 5]  # the last posture of the first sign
    assert path[0, wrist : wrist + 3] == pytest.approx(before, abs=0.002)
    assert len(path) == sum(n for _, n, _ in made["interpolation"]["frames"])
    assert frames > 3


def test_densities_of_both_wrists_are_the_posterior_of_each_order(tmp_path):
    _, data = pages_of(tmp_path, [signer()], binned=True)
    found = {(one["hand"], one["order"]): one for one in data["densities"]}
    assert set(found) == {(hand, order) for hand in ("right", "left") for order in range(8)}
    series = SeriesSettings.of(Settings())
    x, bin_s, at = wrist_in_bins(signer(), "right", series)
    prior = prior_of(series.prior, 0.001, x, "m")
    longest = round(series.continuous.longest_segment_s / bin_s)
    for order in (0, 3, 7):
        posterior = fit(x, [order], prior, bin_s, sample_at=at, max_segment_bins=longest)
        one = found["right", order]
        curve = unpacked(one["values"])[:, 0]
        assert np.abs(curve - posterior.boundary_probability(order)).max() <= 0.0021
        times = np.cumsum(one["times"]) / 1000
        assert times == pytest.approx(posterior.boundaries_s(order), abs=6e-4)
        assert one["first"] == pytest.approx(posterior.times_s([0])[0])
    assert sum(found["left", order]["probability"] for order in range(8)) == pytest.approx(
        1, abs=1e-3
    )
    # The order of the run's tables has the same boundaries in both.
    stems = {one["hand"]: one for one in data["boundaries"]}
    assert stems["right"]["order"] == 3 and stems["right"]["times"] == found["right", 3]["times"]


def test_where_densities_cannot_be_worked_out_the_page_has_the_tables_boundaries(
    tmp_path, monkeypatch
):
    def fail(*given, **more):
        raise IndexError("index 0 is out of bounds")

    monkeypatch.setattr("signkin.explorer.densities.fit", fail)
    _, data = pages_of(tmp_path, [signer()], binned=True)
    assert data["densities"] == [] and len(data["boundaries"]) == 2
    assert any("No density of boundaries: IndexError" in text for text in data["missing"])


def test_a_very_long_recording_has_the_density_of_one_order(tmp_path, monkeypatch):
    monkeypatch.setattr("signkin.explorer.densities.MOST_BINS", 100)
    _, data = pages_of(tmp_path, [signer()], binned=True)
    assert {one["order"] for one in data["densities"]} == {3}
    assert any("density of boundaries is of one order" in text for text in data["missing"])


def test_a_gloss_cannot_leave_its_place(tmp_path):
    html, data = pages_of(tmp_path, [signer()], SIGNS)
    assert HOSTILE in data["labels"] and "L" * 200 in data["labels"]
    assert HOSTILE not in html and "<script>document" not in html
    assert "</script>" not in as_json({"gloss": "</script><!--"})


def test_what_is_missing_is_told(tmp_path):
    recording = signer(flat=True, unit="px")
    _, data = pages_of(tmp_path, [recording])
    told = " ".join(data["missing"])
    assert "No tags" in told and "Flat (2-D)" in told and "No boundaries by binning" in told
    assert data["skeleton"]["flat"] and data["syntheses"] is None


def test_one_sign_alone_has_no_transition_and_its_page_says_so(tmp_path):
    _, data = pages_of(tmp_path, [signer()], SIGNS[:1])
    assert data["transitions"]["rows"] == []
    assert any(text.startswith("No transition") for text in data["missing"])


def test_a_wrist_that_was_never_seen_leaves_a_page_with_the_reason(tmp_path):
    riddled = signer("riddled")
    riddled.positions[:, 10] = np.nan
    pages_of(tmp_path, [signer(), riddled])
    _, data = content_of(tmp_path, "riddled")
    assert data["speeds"] is None
    assert "left_wrist" in data["troubles"][0] and "Left out" in data["troubles"][0]
    assert "No speed: the wrists of this recording cannot be used." in data["missing"]


def test_no_more_pages_than_allowed_and_the_list_tells_the_others(tmp_path):
    names = [f"r{i}" for i in range(9)]
    sources = made_up(tmp_path / "made", [signer(n, 2.0) for n in names], most=3)
    write_pages(sources, tmp_path / "pages", tmp_path / "pages.html")
    made = sorted(path.stem for path in (tmp_path / "pages").iterdir())
    assert len(made) == 3
    listing = (tmp_path / "pages.html").read_text(encoding="utf-8")
    assert "3 of 9 recordings have a page" in listing and "report.explorer_recordings" in listing
    assert listing.count('<a href="pages/') == 3
    first, last = (
        (tmp_path / "pages" / f"{name}.html").read_text(encoding="utf-8")
        for name in (made[0], made[-1])
    )
    assert f'href="{made[1]}.html" rel="next"' in first and 'rel="prev"' not in first
    assert f'href="{made[1]}.html" rel="prev"' in last and 'rel="next"' not in last


def test_half_of_the_pages_go_to_those_with_most_to_look_at():
    names = [f"r{i:03d}" for i in range(100)]
    found = chosen(names, {"r071": 9, "r072": 3, "r073": 4}, 4)
    assert {"r071", "r073"} <= set(found) and len(found) == 4
    assert found == sorted(found)
    assert {"r000", "r099"} <= set(found)
    assert chosen(names, {}, None) == names == chosen(names, {}, 100)
    assert chosen(names, {"r004": 1}, 1) in (["r000"], ["r004"])


def test_an_analysis_that_is_not_there_leaves_the_rest_of_the_page(tmp_path):
    """Its tables have no rows and its Parquet files no columns (signkin.unavailable)."""
    sources = made_up(tmp_path / "made", [signer(seconds=2.0)], SIGNS[:2])
    tables = {
        name: frame.iloc[:0] for name, frame in sources.tables.items() if name != "recordings"
    }
    pd.DataFrame().to_parquet(tmp_path / "empty.parquet")
    bare = replace(
        sources,
        tables={**tables, "recordings": sources.tables["recordings"]},
        frames=[tmp_path / "empty.parquet"],
        posteriors=[tmp_path / "empty.parquet"],
    )
    write_pages(bare, tmp_path / "pages", tmp_path / "pages.html")
    _, data = content_of(tmp_path)
    assert data["skeleton"]["positions"]["rows"] == 100
    assert data["speeds"] is None and data["densities"] == [] and data["lanes"] == []


def test_recordings_come_in_the_order_of_the_list_to_work_through():
    rows = [("far", 0.4, "far"), ("near", 0.1, "moved"), ("farther", 0.9, "far"),
            ("nowhere", np.nan, "far")]  # fmt: skip
    tags = pd.DataFrame(
        [{"recording": r, "sign": 1, "edge": "start", "distance_s": d, "status": s}
         for r, d, s in rows]
    )  # fmt: skip
    none = pd.DataFrame({"recording": ["wrong"], "verdict": ["implausible"]})
    given = {"plausibility": none, "excluded": none[:0], "boundaries": tags}
    grave = Sources(None, None, [], [], [], given).gravity()
    order = sorted(grave, key=lambda name: -grave[name])
    assert order == ["wrong", "nowhere", "farther", "far", "near"]
    assert grave["near"] == 0
