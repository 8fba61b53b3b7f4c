"""The corpora of single signs: facts found in the archives without this project's readers."""

import re
import tarfile

import numpy as np
import pytest

from signkin.corpus import load_corpus
from signkin.io import kinect
from signkin.kinematics import check_recording, lowpass, speed
from signkin.stages.ingest import ingest

ARCHIVES = {"auslan-hq": "tctodd.tar.gz", "isl-kinect": "RawDataset.tar.gz"}


def opened(name, root, real_data):
    folder = real_data / name
    if not (folder / ARCHIVES[name]).is_file():
        pytest.skip(f"real recordings: no {name} in {real_data}")
    corpus = load_corpus(root / "corpora" / name)
    return corpus, folder


@pytest.fixture(scope="module")
def auslan(root, real_data):
    corpus, folder = opened("auslan-hq", root, real_data)
    return corpus, folder, ingest(corpus, folder, corpus.entries)


@pytest.fixture(scope="module")
def isl(root, real_data):
    corpus, folder = opened("isl-kinect", root, real_data)
    return corpus, folder, ingest(corpus, folder, corpus.entries)


def members(folder, archive):
    """Return the members of an archive as arrays, read by NumPy."""
    with tarfile.open(folder / archive) as tar:
        return {m.name: np.loadtxt(tar.extractfile(m)) for m in tar if m.isfile()}


def test_auslan_has_95_signs_in_27_repetitions(auslan):
    corpus, folder, found = auslan
    assert len(found.recordings) == 2565
    assert not found.excluded
    signs = {row["sign"] for row in found.about}
    assert len(signs) == 95
    cells = {(row["sign"], row["repetition"]) for row in found.about}
    assert cells == {(sign, k) for sign in signs for k in range(1, 28)}
    with tarfile.open(folder / ARCHIVES["auslan-hq"]) as tar:
        assert {e.part for e in corpus.entries} == {m.name for m in tar if m.isfile()}
    for entry in corpus.entries:
        session, sign, k = re.fullmatch(r"tctodd(\d)/(.*)-(\d)\.tsd", entry.part).groups()
        assert (entry.sign, entry.repetition) == (sign, 3 * (int(session) - 1) + int(k))


def test_auslan_hands_are_the_archives_numbers(auslan):
    corpus, folder, found = auslan
    raw = members(folder, ARCHIVES["auslan-hq"])
    for entry, recording in list(zip(corpus.entries, found.recordings, strict=True))[::20]:
        table = raw[entry.part]
        for hand, first in (("left", 0), ("right", 11)):
            x, y, z = table[:, first : first + 3].T
            assert (recording.track(f"{hand}_wrist") == np.column_stack([x, -z, y])).all()


def median_shift(found, sign, axis):
    """Return how far the right hand is from its rest, at the sign's farthest place (median)."""
    shifts = []
    for row, recording in zip(found.about, found.recordings, strict=True):
        if row["sign"] == sign:
            away = recording.track("right_wrist") - recording.track("right_wrist")[-10:].mean(
                axis=0
            )
            shifts.append(away[np.linalg.norm(away, axis=1).argmax(), axis])
    return np.median(shifts)


def test_auslan_axes_follow_where_signs_are_made(auslan):
    """Up: signs at the forehead. Forward: away from the body; back: at the face or chest."""
    found = auslan[2]
    assert min(median_shift(found, sign, 2) for sign in ("think", "know", "head")) > 0.4
    assert max(median_shift(found, sign, 1) for sign in ("hear", "deaf", "mine")) < -0.15
    assert min(median_shift(found, sign, 1) for sign in ("you", "tray")) > 0.05
    ends = [r.positions[-10:].mean(axis=0) for r in found.recordings]
    right, left = found.recordings[0].index("right_wrist"), found.recordings[0].index("left_wrist")
    assert np.mean([end[right, 0] > end[left, 0] for end in ends]) > 0.99


def fastest(recordings, hand="right"):
    """Return the 95th percentile of the low-passed wrist speed of each recording, m/s."""
    out = []
    for r in recordings:
        moving = speed(lowpass(r.track(f"{hand}_wrist"), r.rate_hz, 6.0), r.rate_hz)
        out.append(np.percentile(moving, 95))
    return np.array(out)


def test_auslan_speeds_are_human_at_the_declared_rate_and_not_at_the_donors(auslan):
    recordings = auslan[2].recordings[::5]
    fast = fastest(recordings)
    assert 0.8 < np.median(fast) < 2.0
    assert np.percentile(fast, 99) < 3.5
    assert np.median(fast) * 100 / recordings[0].rate_hz > 4
    speeds = [f for r in recordings for f in check_recording(r) if "right wrist speed" in f.check]
    assert {f.verdict for f in speeds} == {"plausible"}


def test_isl_has_five_signs_of_ten_signers_in_nine_repetitions(isl):
    corpus, _, found = isl
    assert len(found.recordings) == 450
    assert not found.excluded
    signs = {row["sign"] for row in found.about}
    signers = {row["signer"] for row in found.about}
    assert (len(signs), len(signers)) == (5, 10)
    cells = {(row["sign"], row["signer"], row["repetition"]) for row in found.about}
    assert cells == {(s, g, k) for s in signs for g in signers for k in range(1, 10)}
    for entry in corpus.entries:
        assert entry.part == f"RawDataset/{entry.sign}_{entry.signer}_{entry.repetition}.txt"


LIMBS = {
    ("shoulder", "elbow"): (0.19, 0.29), ("elbow", "wrist"): (0.18, 0.28),
    ("wrist", "hand"): (0.04, 0.12), ("hip", "knee"): (0.38, 0.58), ("knee", "ankle"): (0.30, 0.48),
    ("ankle", "foot"): (0.05, 0.15),
}  # fmt: skip


def test_isl_joints_in_this_order_have_limbs_of_human_length(isl):
    """Each limb has a human length, the same on both sides, and no other pairing does better."""
    raw = np.concatenate(list(members(isl[1], ARCHIVES["isl-kinect"]).values()))
    points = raw.reshape(len(raw), 20, 3)[::10]
    at = {name: points[:, i] for i, name in enumerate(kinect.JOINTS)}

    def length(a, b):
        return float(np.median(np.linalg.norm(at[a] - at[b], axis=1)))

    for (a, b), (low, high) in LIMBS.items():
        right, left = (length(f"{side}_{a}", f"{side}_{b}") for side in ("right", "left"))
        assert low < right < high, (a, b)
        assert right == pytest.approx(left, rel=0.16), (a, b)
        # A limb keeps its length; the way to the other side's joint does not.
        own = np.std(np.linalg.norm(at[f"left_{a}"] - at[f"left_{b}"], axis=1))
        crossed = np.std(np.linalg.norm(at[f"left_{a}"] - at[f"right_{b}"], axis=1))
        assert own < crossed, (a, b)
    assert 0.15 < length("head", "neck") < 0.25
    assert 0.3 < length("left_shoulder", "right_shoulder") < 0.4
    heights = [np.median(at[j][:, 1]) for j in ("head", "neck", "spine", "hip_centre", "left_knee")]
    assert (np.diff(heights) < 0).all()


def test_isl_signers_face_forward_and_use_the_right_hand(isl):
    found = isl[2]
    for recording in found.recordings:
        shoulders = np.median(
            recording.track("right_shoulder") - recording.track("left_shoulder"), axis=0
        )
        assert shoulders[0] > 0.15
        assert shoulders[1] == pytest.approx(0, abs=0.05)
    one = {"bye", "child", "daily"}
    for signer in {row["signer"] for row in found.about}:
        own = [
            recording
            for row, recording in zip(found.about, found.recordings, strict=True)
            if row["signer"] == signer and row["sign"] in one
        ]
        assert np.median(fastest(own)) > 2 * np.median(fastest(own, "left"))
        # The signing hand is before the body, not behind it: right is right.
        ahead = [np.percentile((r.track("right_wrist") - r.track("spine"))[:, 1], 90) for r in own]
        assert np.median(ahead) > 0.15


def test_isl_speeds_and_lengths_are_plausible_but_for_what_is_told(isl):
    found = isl[2]
    assert 0.5 < np.median(fastest(found.recordings)) < 2.0
    bad = [
        f.check for r in found.recordings for f in check_recording(r) if f.verdict == "implausible"
    ]
    # The turned-away right arm is measured too short in a fifth of the recordings.
    assert {check: bad.count(check) for check in set(bad)} == {
        "right upper arm": 90, "right wrist speed, 99th percentile": 2, "shoulder width": 1,
    }  # fmt: skip
