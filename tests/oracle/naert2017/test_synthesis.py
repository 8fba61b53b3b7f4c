"""Utterances from real recordings: read back, read by a peer, and against brute force."""

from itertools import product

import bvhio
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from signkin import read_recording, tables
from signkin.corpus import load_corpus
from signkin.errors import SignkinError
from signkin.io.bvh import channel_values, forward_kinematics, parse_bvh
from signkin.io.wide_csv import column_map
from signkin.settings import Settings
from signkin.stages.ingest import ingest
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis import readings
from signkin.studies.naert2017.synthesis.comparison import comparison
from signkin.studies.naert2017.synthesis.database import sign_database
from signkin.studies.naert2017.synthesis.duration_models import timing
from signkin.studies.naert2017.synthesis.retrieval import distance_scale, retrieved
from signkin.studies.naert2017.synthesis.summary import summary
from signkin.studies.naert2017.synthesis.utterance import make_utterance
from signkin.studies.naert2017.synthesis.utterance_files import whole_takes, write_utterance

PRINTED = np.array([0.148777, 0.663958, 0.275229])


@pytest.fixture(scope="module")
def settings():
    return SynthesisSettings.of(Settings())


def stock(root, data, name, settings):
    corpus = load_corpus(root / "corpora" / name)
    folder = data / name
    read = ingest(corpus, folder, corpus.entries)
    base, found = sign_database(corpus, read.recordings, read.table("intervals"), settings)
    return corpus, folder, base, found


@pytest.fixture(scope="module")
def libras(root, real_corpora, settings):
    return stock(root, real_corpora, "libras", settings)


@pytest.fixture(scope="module")
def dgs(root, real_corpora, settings):
    return stock(root, real_corpora, "dgs-1984189", settings)


@pytest.fixture(scope="module")
def spoken(libras, settings, tmp_path_factory):
    corpus, folder, base, _ = libras
    tokens = retrieved(base, ["BOCA", "ENTENDER"], "chain")
    takes = whole_takes(corpus, folder, base, ["boca", "entender"], align=True)
    clock = timing(base, "surface", settings.durations, PRINTED)
    made = make_utterance(base, tokens, clock, settings.synthesis, takes)
    path = write_utterance(made, corpus, folder, "boca", tmp_path_factory.mktemp("bvh") / "said")
    return made, path


def test_a_written_bvh_read_back_is_the_same_motion(libras, spoken):
    corpus, _, _, _ = libras
    made, path = spoken
    spec = {**corpus.motion_spec(corpus.entries[0]), "joints": None, "name": None}
    again = read_recording(path, **spec)
    assert again.joints == made.motion.joints and len(again.joints) > 30
    assert np.abs(again.positions - made.motion.positions).max() < 1e-6
    angles = [
        (Rotation.from_quat(a).inv() * Rotation.from_quat(b)).magnitude().max()
        for a, b in zip(again.orientations, made.motion.orientations, strict=True)
    ]
    assert max(angles) < 1e-6


def test_hierarchy_and_rate_are_those_of_the_recording(libras, spoken):
    _, folder, _, _ = libras
    source, _, rate = parse_bvh(folder / "source_animation-boca.bvh")
    hierarchy, values, written = parse_bvh(spoken[1])
    assert (hierarchy.joints, hierarchy.parents) == (source.joints, source.parents)
    assert hierarchy.channels == source.channels and written == pytest.approx(rate, rel=1e-5)
    rotation = [c.endswith("rotation") for joint in hierarchy.channels for c in joint]
    # Between frames a program interpolates angles: none may jump.
    assert np.abs(np.diff(values[:, rotation], axis=0)).max() < 30


def test_bvhio_reads_the_same_positions(spoken):
    made, path = spoken
    root = bvhio.readAsHierarchy(str(path))
    hierarchy, values, _ = parse_bvh(path)
    expected = forward_kinematics(hierarchy, values)[0]
    for frame in (0, made.motion.frames // 2, made.motion.frames - 1):
        root.loadPose(frame)
        for joint, _, _ in root.layout():
            found = np.array(joint.PositionWorld)
            at = expected[frame, hierarchy.joints.index(joint.Name)]
            assert found == pytest.approx(at, abs=1e-2), joint.Name  # cm; bvhio is 32 bits


def test_a_real_file_through_world_poses_and_back_is_the_same(libras):
    _, folder, _, _ = libras
    hierarchy, values, _ = parse_bvh(folder / "source_animation-entender.bvh")
    posed = forward_kinematics(hierarchy, values)
    again = forward_kinematics(hierarchy, channel_values(hierarchy, *posed))
    assert np.abs(again[0] - posed[0]).max() < 1e-8
    assert np.abs((again[1] * posed[1]).sum(-1)).min() > 1 - 1e-12


def test_signs_of_takes_without_tags_are_found_while_the_hand_is_up(libras):
    _, _, base, found = libras
    for row in found.itertuples():
        take = base.recordings[row.recording]
        height = take.track("right_wrist")[:, 2]
        inside = height[take.frame_at(row.start_s) : take.frame_at(row.end_s) + 1]
        assert 1.0 < row.end_s - row.start_s < 4.0
        assert inside.min() > height.min() + 0.3  # the rest parts and the T-pose are not in it


def test_both_takes_are_told_to_differ_in_their_skeletons(spoken):
    assert "put on the skeleton of boca" in spoken[0].parts["note"].iloc[-1]


def test_marker_like_recordings_come_as_tables_that_read_back(dgs, settings, tmp_path):
    corpus, folder, base, _ = dgs
    tokens = retrieved(base, ["CAT3", "BIRD1", "HOTEL1*"], "chain")
    clock = timing(base, "surface", settings.durations, PRINTED)
    made = make_utterance(base, tokens, clock, settings.synthesis)
    path = write_utterance(made, corpus, folder, "1984189", tmp_path / "said")
    again = read_recording(path, unit="m", time_column="time_s", joints=column_map(made.motion))
    assert again.rate_hz == pytest.approx(50)
    assert np.nanmax(np.abs(again.positions - made.motion.positions)) < 1e-6
    assert (np.isnan(again.positions) == np.isnan(made.motion.positions)).all()


def test_the_chain_on_real_signs_is_the_one_that_trying_all_finds(dgs):
    _, _, base, _ = dgs
    glosses = ["$PROD*", "CAT3", "BIRD1", "BINOCULARS1*"]
    scale, known = distance_scale(base), base.glosses()

    def cost(chain):
        data = base.features(chain[:-1], chain[1:])
        euclidean = data.euclidean * base.euclidean_unit / scale.euclidean
        return float(((euclidean + data.geodesic / scale.geodesic_rad) / 2).sum())

    found = retrieved(base, glosses, "chain")
    best = min(cost(chain) for chain in product(*(known[g] for g in glosses)))
    assert cost(found) == pytest.approx(best)
    assert cost(retrieved(base, glosses, "greedy")) >= best - 1e-12


def test_an_unknown_gloss_is_told_with_near_ones(dgs):
    with pytest.raises(SignkinError, match=r"'CAT' does not occur; .*near ones: CAT3"):
        retrieved(dgs[2], ["CAT"], "chain")


def test_blending_the_captured_material_in_true_time_has_no_error(dgs, settings):
    corpus, _, base, _ = dgs
    rows = comparison(base, settings)
    itself = rows[rows["note"].str.contains("captured motion itself")]
    assert len(itself) > 40 and itself["error_m"].max() < 1e-9
    assert (itself["extra_minima"].dropna() == 0).all()
    # The paper's claim: where blending reaches into another sign, the avatar hesitates.
    own = rows[(rows["material"] == "own") & (rows["method"] == "blending")]
    over = own[own["overrun_s"] > 0.1]["extra_minima"].mean()
    assert over > own[own["overrun_s"] == 0]["extra_minima"].mean() + 0.5
    errors = summary(rows, corpus, 200, 1)
    assert list(errors.columns) == tables.TABLES["synthesis_summary"].names()
    assert (errors["low"] <= errors["mean"] + 1e-12).sum() == errors["mean"].notna().sum()
    assert errors.equals(summary(rows, corpus, 200, 1))


def test_a_list_is_nearer_by_the_chain_than_from_sign_to_sign(dgs, settings, monkeypatch):
    monkeypatch.setattr(readings, "LISTS", 40)
    monkeypatch.setattr(readings, "MOST", 4)
    found = readings.synthesis_readings(dgs[2], settings, 1)
    assert list(found.columns) == tables.TABLES["readings_synthesis"].names()
    chosen = found[found["rule"] == "retrieval"].set_index("reading")
    assert chosen["printed"].to_dict() == {"chain": "no", "greedy": "yes"}
    assert (chosen["n"] == 40).all() and chosen.loc["chain", "mean"] < chosen.loc["greedy", "mean"]
    errors = found[found["measure"] == "position error"].set_index("reading")["mean"]
    assert errors["slerp"] == errors["linear"] > 0  # positions alone are mixed here
