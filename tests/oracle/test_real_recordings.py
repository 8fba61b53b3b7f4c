"""Facts about the real recordings that were found without this project's code."""

import re
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from pympi.Elan import Eaf

from signkin import read_annotation, read_recording
from signkin.corpus import load_corpus
from signkin.io.eaf import NewTier, insert_tiers
from signkin.kinematics import check_recording, with_limb_frames
from signkin.stages.ingest import ingest


@pytest.fixture(scope="module")
def dgs(root, real_corpora):
    corpus = load_corpus(root / "corpora/dgs-1984189")
    return ingest(corpus, real_corpora / "dgs-1984189", corpus.entries).recordings[0]


def length(recording, a, b):
    return np.linalg.norm(recording.track(a) - recording.track(b), axis=1)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize(
    ("a", "b", "low", "high"),
    [
        ("shoulder", "elbow", 0.20, 0.30), ("elbow", "wrist", 0.20, 0.30),
        ("wrist", "middle_1", 0.07, 0.11), ("wrist", "middle_tip", 0.12, 0.21),
    ],
)  # fmt: skip
def test_world_landmarks_have_limbs_of_human_length(dgs, hand, a, b, low, high):
    limb = length(dgs, f"{hand}_{a}", f"{hand}_{b}")
    assert low < np.nanmedian(limb) < high
    if b != "middle_tip":  # a finger bends
        assert np.nanstd(limb) / np.nanmedian(limb) < 0.2


def test_left_unscaled_the_same_limbs_would_not_keep_their_length(dgs):
    """The trap: x and y still times the image's size make a limb's length depend on its turn."""
    stretched = dgs.positions * [640, 1, 360]  # canonical x and z are the image's x and y
    ends = (dgs.index("right_elbow"), dgs.index("right_wrist"))
    limb = np.linalg.norm(stretched[:, ends[0]] - stretched[:, ends[1]], axis=1)
    good = length(dgs, "right_elbow", "right_wrist")
    assert np.std(limb) / np.median(limb) > 3 * np.std(good) / np.median(good)


def test_the_recording_is_plausible_and_its_gaps_are_the_trackers(dgs):
    assert {f.verdict for f in check_recording(dgs)} == {"plausible"}
    assert (dgs.frames, dgs.rate_hz, dgs.unit) == (2297, 50.0, "m")
    assert not np.isnan(dgs.track("right_wrist")).any()
    hand = np.isnan(dgs.track("right_index_tip")).any(axis=1)
    assert 0.01 < hand.mean() < 0.05


def test_palm_frames_follow_the_knuckles(dgs):
    again = with_limb_frames(dgs.without_orientations())
    from scipy.spatial.transform import Rotation

    j = again.index("right_wrist")
    q = again.orientations[:, j]
    there = ~np.isnan(q).any(axis=1)
    across = (dgs.track("right_index_1") - dgs.track("right_pinky_1"))[there]
    local = Rotation.from_quat(q[there]).inv().apply(across)
    assert (local[:, 1] > 0).all()
    assert np.abs(local[:, 2]).max() < 1e-9


def test_the_right_tiers_have_62_signs_and_the_child_has_its_parents_times(real_corpora):
    path = real_corpora / "dgs-1984189/1984189.eaf"
    tiers = ("Lexeme_Sign_r_B", "Lexem_Gebärde_r_B")
    a = read_annotation(path, tiers=tiers)
    child, parent = a.tier(tiers[0]), a.tier(tiers[1])
    assert len(child) == len(parent) == 62
    assert [(i.start_s, i.end_s) for i in child] == [(i.start_s, i.end_s) for i in parent]
    raw = sorted(Eaf(str(path)).get_annotation_data_for_tier(tiers[1]))
    assert [(i.start_s * 1000, i.end_s * 1000) for i in parent] == [
        (pytest.approx(start), pytest.approx(end)) for start, end, *_ in raw
    ]
    gaps = np.array([b.start_s - a.end_s for a, b in pairwise(parent)])
    assert (len(gaps), round(gaps.mean(), 3), round(gaps.std(ddof=1), 3)) == (61, 0.347, 0.208)


def test_a_real_elan_file_keeps_every_byte(real_corpora, tmp_path):
    content = (real_corpora / "dgs-1984189/1984189.eaf").read_bytes()
    signs = read_annotation(real_corpora / "dgs-1984189/1984189.eaf", tiers=("Lexeme_Sign_r_B",))
    new = insert_tiers(content, [NewTier("signkin refined right", signs.intervals)])
    assert insert_tiers(new, [NewTier("signkin refined right", signs.intervals)]) == new
    added = (
        rb'<TIME_SLOT TIME_SLOT_ID="signkin_[^>]*/>',
        rb'<TIER TIER_ID="signkin refined right" .*?</TIER>',
        rb'<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="signkin-[^>]*/>',
    )
    assert re.sub(b"|".join(added), b"", new, flags=re.DOTALL) == content
    path = tmp_path / "x.eaf"
    path.write_bytes(new)
    before, after = Eaf(str(real_corpora / "dgs-1984189/1984189.eaf")), Eaf(str(path))
    for tier in before.get_tier_names():
        assert before.get_annotation_data_for_tier(tier) == after.get_annotation_data_for_tier(tier)
    assert len(after.get_annotation_data_for_tier("signkin refined right")) == 62


def test_boston_has_888_words_of_201_sentences_in_pixels(root, real_corpora):
    corpus = load_corpus(root / "corpora/boston104")
    found = ingest(corpus, real_corpora / "boston104", corpus.entries)
    assert len(found.recordings) == 201
    assert sum(r.frames for r in found.recordings) == 15746
    assert sum(row["signs"] for row in found.about) == 888
    assert {r.unit for r in found.recordings} == {"px"}
    raw = pd.read_csv(real_corpora / "boston104/hands_condensed.csv")
    for recording, entry in zip(found.recordings, corpus.entries, strict=True):
        rows = raw[raw["video"] == int(entry.part)].sort_values("frame")
        right = recording.track("right_wrist")
        assert (-right[:, 0] == rows["right-x"]).all()
        assert (-right[:, 2] == rows["right-y"]).all()
    speakers = pd.read_csv(real_corpora / "boston104/speaker.csv").set_index("video")["speaker"]
    assert all(e.signer == speakers[int(e.part)] for e in corpus.entries)


def test_libras_is_read_in_metres_with_orientations(root, real_corpora):
    corpus = load_corpus(root / "corpora/libras")
    found = ingest(corpus, real_corpora / "libras", corpus.entries).recordings
    assert [(r.frames, r.rate_hz) for r in found] == [(948, 120.0), (647, 120.0)]
    for r in found:
        assert r.orientations is not None
        assert {f.verdict for f in check_recording(r)} == {"plausible"}
    path = real_corpora / "libras/source_animation-boca.bvh"
    assert read_recording(path, unit="cm").rate_hz == pytest.approx(120, rel=1e-5)
