"""A look at a corpus: what is spoilt is told, what is right is left alone."""

from dataclasses import replace

import numpy as np
import pytest

from signkin.__main__ import main
from signkin.annotation import Interval
from signkin.corpus import Corpus, load_corpus
from signkin.recording import Recording
from signkin.survey.clock import clock_offset
from signkin.survey.look import look_at
from signkin.survey.motion import motion_notices, noise_sd
from signkin.survey.skeletons import joint_map
from signkin.survey.tags import fastest_wrist, tag_notices
from support.runs import ROOT

RATE = 100.0
JOINTS = ("head", "pelvis", "right_shoulder", "left_shoulder", "right_elbow", "left_elbow",
          "right_wrist", "left_wrist")  # fmt: skip


def signing(seconds=30.0, seed=1, noise=0.0005):
    """Return a signer whose wrists go from place to place and rest in each, and the rests."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * RATE)) / RATE
    stops = np.cumsum(rng.uniform(0.25, 0.6, size=round(seconds / 0.3)))
    stops = stops[stops < seconds - 0.5]
    places = rng.normal(0, 0.08, (len(stops) + 1, 3))
    path = np.zeros((len(t), 3))
    for i, (a, b) in enumerate(zip(stops, np.append(stops[1:], seconds), strict=True)):
        u = np.clip((t - a) / (b - a), 0, 1)
        u = 10 * u**3 - 15 * u**4 + 6 * u**5
        there = t >= a
        path[there] = (places[i] + u[:, None] * (places[i + 1] - places[i]))[there]
    fixed = {"head": [0, 0, 1.65], "pelvis": [0, 0, 1.0], "right_shoulder": [0.18, 0, 1.4],
             "left_shoulder": [-0.18, 0, 1.4]}  # fmt: skip
    positions = np.zeros((len(t), len(JOINTS), 3))
    for joint, place in fixed.items():
        positions[:, JOINTS.index(joint)] = place
    for side, hand in ((1, "right"), (-1, "left")):
        elbow = np.array([0.25 * side, 0.05, 1.12])
        ahead = np.array([0.0, 0.25, 0.0]) + path * [side, 1, 1]
        ahead *= 0.25 / np.linalg.norm(ahead, axis=1)[:, None]
        positions[:, JOINTS.index(f"{hand}_elbow")] = elbow
        positions[:, JOINTS.index(f"{hand}_wrist")] = elbow + ahead
    positions += rng.normal(0, noise, positions.shape)
    return (
        Recording(name="r", rate_hz=RATE, joints=JOINTS, positions=positions, unit="m"), stops
    )  # fmt: skip


def tags_of(stops, shift=0.0):
    pairs = zip(stops[:-1:2], stops[1::2], strict=False)
    return [Interval(a + shift, b + shift, "G", "sign") for a, b in pairs]


def bad(notices):
    return {n.check: n for n in notices if n.level in ("wrong", "look")}


def test_a_right_recording_is_left_alone():
    recording, stops = signing()
    assert not bad(motion_notices(recording))
    assert not bad(tag_notices(recording, tags_of(stops)))
    assert noise_sd(recording) == pytest.approx(0.0005, rel=0.1)


def swapped(r):
    order = [r.joints.index(_other(j)) for j in r.joints]
    return replace(r, positions=r.positions[:, order])


def _other(joint):
    side, _, part = joint.partition("_")
    return {"right": f"left_{part}", "left": f"right_{part}"}.get(side, joint)


def frozen(r):
    positions = r.positions.copy()
    positions[500:600] = positions[500]
    return replace(r, positions=positions)


def torn(r):
    positions = r.positions.copy()
    positions[100::200, JOINTS.index("right_wrist")] += 0.5
    return replace(r, positions=positions)


def gappy(r):
    positions = r.positions.copy()
    positions[:900, JOINTS.index("left_wrist")] = np.nan
    return replace(r, positions=positions)


@pytest.mark.parametrize(
    ("spoil", "check", "level"),
    [
        (swapped, "shoulders, right of left", "wrong"),
        (lambda r: replace(r, positions=r.positions * [1, 1, -1]), "upright, head above pelvis",
         "wrong"),
        (lambda r: replace(r, positions=r.positions * [-1, 1, 1]), "shoulders, right of left",
         "wrong"),
        (lambda r: replace(r, positions=r.positions * 1000), "space of the hands", "wrong"),
        (lambda r: replace(r, rate_hz=RATE * 8), "right wrist speed, 99th percentile", "look"),
        (lambda r: replace(r, rate_hz=RATE / 4), "tempo", "look"),
        (frozen, "right wrist, longest frozen stretch", "look"),
        (torn, "right wrist, jumps", "look"),
        (gappy, "left wrist, missing", "look"),
        (gappy, "left wrist, longest gap", "look"),
    ],
)  # fmt: skip
def test_what_is_spoilt_is_told(spoil, check, level):
    recording, _ = signing()
    assert bad(motion_notices(spoil(recording)))[check].level == level


@pytest.mark.parametrize("shift", [-5.0, -1.3, 0.8, 5.0])
def test_a_shifted_clock_is_found_and_measured(shift):
    recording, stops = signing(60.0)
    inside = [t for t in tags_of(stops, shift) if t.start_s >= 0 and t.end_s <= 60]
    notice = bad(tag_notices(recording, inside))["clock, tags to motion"]
    assert notice.level == "wrong"
    assert notice.value == pytest.approx(-shift, abs=0.1)


def test_random_tags_have_no_certain_clock():
    """The share of recordings whose random tags are called shifted stays small."""
    called = 0
    for seed in range(40):
        recording, _ = signing(40.0, seed)
        edges = np.sort(np.random.default_rng(seed).uniform(0, 40, 60))
        found = clock_offset(fastest_wrist(recording), RATE, edges)
        called += found is not None and found.wrong
    assert called <= 4


def test_tags_are_checked_against_one_another():
    recording, stops = signing()
    tags = tags_of(stops)
    over = [*tags, Interval(tags[0].start_s + 0.01, tags[0].end_s, "", "sign")]
    found = bad(tag_notices(recording, sorted(over)))
    assert {"tags, overlapping", "tags without a gloss"} <= set(found)
    assert "tags, median length" in bad(
        tag_notices(recording, [Interval(i * 3.0, i * 3.0 + 2.9, "G", "sign") for i in range(9)])
    )
    assert bad(tag_notices(recording, []))["tags"].todo == "the sign tier is empty here"


def changed(corpus: Corpus, **motion) -> Corpus:
    return replace(corpus, settings={**corpus.settings, "motion": {
        **corpus.settings["motion"], **motion}})  # fmt: skip


def spoilt_sides(corpus: Corpus) -> Corpus:
    joints = {_other(j): source for j, source in corpus.settings["motion"]["joints"].items()}
    return changed(corpus, joints=joints)


@pytest.mark.parametrize("name", ["boston104", "dgs-1984189", "libras"])
def test_real_corpora_are_not_called_wrong_and_spoilt_ones_are(real_corpora, name):
    """As they are: nothing `wrong`. Swapped, mirrored, upside down, px as m, rate: told."""
    corpus = load_corpus(ROOT / "corpora" / name)
    folder = real_corpora / corpus.settings["data_folder"]

    def told(spoilt):
        look = look_at(spoilt, folder, 12)
        return {line.partition(" (")[0] for line in look.first}

    as_it_is = told(corpus)
    assert not [line for line in as_it_is if line.startswith("wrong")]
    motion = corpus.settings["motion"]
    opposite = {a: a[1:] if a[0] == "-" else f"-{a}" for a in (motion["up"], motion["right"])}
    assert [x for x in told(spoilt_sides(corpus)) if x.startswith("wrong") and "right of left" in x]
    assert [x for x in told(changed(corpus, up=opposite[motion["up"]])) if x.startswith("wrong")]
    assert [x for x in told(changed(corpus, right=opposite[motion["right"]]))
            if x.startswith("wrong") and "right of left" in x]  # fmt: skip
    if motion.get("unit") == "px":
        assert "wrong: space of the hands" in told(changed(corpus, unit="m"))
    if "rate_hz" not in motion and corpus.tagged:  # the file tells it; overruled, the tags tell
        half = {"use": 25, "instead_of_file": True}
        assert "look: tags, part of the motion from the first to the last" in told(
            changed(corpus, rate_hz=half)
        )
    if "rate_hz" in motion:
        wrong_rate = told(changed(corpus, rate_hz=motion["rate_hz"] / 2))
        assert wrong_rate & {
            "look: tempo, median of the recordings", "wrong: reading",
        }  # fmt: skip


# --- init


def test_joints_of_known_skeletons_are_recognised():
    suit = ["Hips", "Spine3", "Neck", "Head", "RightShoulder", "RightArm", "RightForeArm",
            "RightHand", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]  # fmt: skip
    found = joint_map(suit)
    assert found["right_shoulder"] == "RightArm"
    assert found["right_clavicle"] == "RightShoulder"
    assert found["left_wrist"] == "LeftHand"
    assert found["pelvis"] == "Hips"
    mixamo = joint_map([f"mixamorig:{name}" for name in suit])
    assert mixamo["right_elbow"] == "mixamorig:RightForeArm"
    openpose = joint_map(["Nose", "Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow",
                          "LWrist", "MidHip"])  # fmt: skip
    assert openpose["right_wrist"] == "RWrist"
    assert openpose["left_shoulder"] == "LShoulder"
    gait = joint_map(["S:RSHO", "S:RELB", "S:RWRA", "S:LSHO", "S:LELB", "S:LWRA", "S:C7"])
    assert gait["right_wrist"] == "S:RWRA"
    assert gait["neck"] == "S:C7"
    media = joint_map(
        [
            "POSE_WORLD_LANDMARKS.RIGHT_WRIST",
            "POSE_LANDMARKS.RIGHT_WRIST",
            "RIGHT_HAND_LANDMARKS.INDEX_FINGER_PIP",
            "RIGHT_HAND_LANDMARKS.THUMB_TIP",
        ]
    )
    assert media["right_wrist"] == "POSE_WORLD_LANDMARKS.RIGHT_WRIST"
    assert media["right_index_2"] == "RIGHT_HAND_LANDMARKS.INDEX_FINGER_PIP"
    assert media["right_thumb_tip"] == "RIGHT_HAND_LANDMARKS.THUMB_TIP"


def test_a_folder_becomes_a_corpus_that_can_be_checked(tmp_path, capsys):
    """Table and TextGrid, in centimetres, y up, x to the signer's left: found out, not told."""
    recording, stops = signing(20.0)
    folder = tmp_path / "data" / "mine"
    folder.mkdir(parents=True)
    file_axes = recording.positions[:, :, [0, 2, 1]] * [-100, 100, 100]
    names = [f"{joint}_{axis}" for joint in JOINTS for axis in "xyz"]
    rows = "\n".join(
        ",".join(f"{v:.4f}" for v in row) for row in file_axes.reshape(len(file_axes), -1)
    )
    (folder / "one.csv").write_text(",".join(names) + "\n" + rows + "\n")
    parts = "".join(
        f"    intervals [{i + 1}]:\n        xmin = {t.start_s}\n        xmax = {t.end_s}\n"
        f'        text = "G{i}"\n'
        for i, t in enumerate(tags_of(stops))
    )
    (folder / "one.TextGrid").write_text(
        'File type = "ooTextFile"\nObject class = "TextGrid"\n\nxmin = 0\nxmax = 20\n'
        "tiers? <exists>\nsize = 1\nitem []:\n    item [1]:\n"
        '        class = "IntervalTier"\n        name = "glosses"\n        xmin = 0\n'
        f"        xmax = 20\n        intervals: size = {len(tags_of(stops))}\n{parts}"
    )
    into = tmp_path / "corpora" / "mine"
    assert main(["corpus", "init", str(folder), "--into", str(into)]) == 0
    said = capsys.readouterr().out
    assert "sampling rate in Hz" in said
    corpus = load_corpus(into)
    motion = corpus.settings["motion"]
    assert (motion["format"], motion["unit"], motion["up"], motion["right"]) == (
        "csv", "cm", "y", "-x",
    )  # fmt: skip
    assert corpus.settings["annotation"]["sign_tier"] == "glosses"
    assert corpus.noise_sd == pytest.approx(0.0005, rel=0.2)
    signs = into / "signs.csv"
    rows = signs.read_text().splitlines()
    assert rows[0] == "gloss,hands,symmetric,source"
    assert rows[1:] == [f"G{i},,,ASK: its type? glosses: 1" for i in range(len(tags_of(stops)))]
    assert corpus.signs == () and f"types of {len(rows) - 1} glosses" in said
    out = tmp_path / "out"
    check = ["corpus", "check", str(into), "--data", str(folder.parent), "--out", str(out)]
    assert main(check) == 0
    assert (out / "index.html").stat().st_size > 1000
    assert main(["corpus", "init", str(folder), "--into", str(into)]) == 1
    assert "it is there already" in capsys.readouterr().err
    signs.write_text("gloss,hands,symmetric\nG0,0,0\n")
    (into / "corpus.yaml").unlink()
    assert main(["corpus", "init", str(folder), "--into", str(into)]) == 0
    assert "signs.csv" not in capsys.readouterr().out
    assert load_corpus(into).lexicon == {"G0": "00"}


def test_init_reads_what_has_to_be_declared_and_asks_for_it(tmp_path, capsys):
    """Landmarks by their number, a clock that starts later, uneven times."""
    folder = tmp_path / "points"
    folder.mkdir()
    rng = np.random.default_rng(1)
    points = rng.normal(400, 100, (1, 33, 2)) + np.cumsum(rng.normal(0, 1, (40, 33, 2)), axis=0)
    np.save(folder / "a.npy", points)
    assert main(["corpus", "init", str(folder), "--into", str(tmp_path / "c1")]) == 0
    assert "whose landmarks are these?" in capsys.readouterr().out
    motion = load_corpus(tmp_path / "c1").settings["motion"]
    assert motion["options"] == {"landmarks": "mediapipe_pose"} and motion["unit"] == "px"
    assert motion["joints"]["right_wrist"] == "RIGHT_WRIST"
    for name, times, asked in (
        ("late", 7 + np.arange(30) / 50, {"clock": "first_frame"}),
        ("uneven", np.cumsum(np.tile([0.021, 0.034], 15)) - 0.021, {"resample_hz": 36.4}),
    ):
        folder = tmp_path / name
        folder.mkdir()
        sides = ",".join(f"{s}_{p}_{a}" for s in ("right", "left") for p in ("wrist", "elbow")
                         for a in "xyz")  # fmt: skip
        rows = [",".join([f"{t:.3f}", *(f"{v:.3f}" for v in rng.normal(size=12))]) for t in times]
        (folder / "m.csv").write_text("\n".join([f"time,{sides}", *rows]) + "\n")
        assert main(["corpus", "init", str(folder), "--into", str(tmp_path / f"c{name}")]) == 0
        assert load_corpus(tmp_path / f"c{name}").settings["motion"]["options"].items() >= (
            asked.items()
        )
        capsys.readouterr()


def test_names_with_dots():
    found = joint_map(["R.Thigh.Rear", "Top.Head", "R.Elbow", "hand.L", "Rear", "L.Ear"])
    assert found == {"right_elbow": "R.Elbow", "left_wrist": "hand.L", "left_ear": "L.Ear"}


def test_a_folder_without_motion_is_told(tmp_path, capsys):
    (tmp_path / "x.bvh").write_text("nothing")
    assert main(["corpus", "init", str(tmp_path), "--into", str(tmp_path / "c")]) == 1
    assert "no motion that can be read" in capsys.readouterr().err


def test_tags_that_end_at_half_of_the_motion_tell_the_rate():
    recording, stops = signing()
    slow = replace(recording, rate_hz=RATE / 2)
    found = bad(tag_notices(slow, tags_of(stops)))
    notice = found["tags, part of the motion from the first to the last"]
    assert "at 100 Hz, not 50, both would last as long" in notice.todo
