"""A folder of files made into the description of a corpus: what can be found out, and what cannot.

`signkin corpus init FOLDER` writes corpus.yaml and recordings.csv. What was guessed carries the
ground of the guess as a comment; what only a person knows is a line that begins with `# ASK`.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io import read_annotation, read_recording
from signkin.io.landmarks import LISTS, MEDIAPIPE_HAND, MEDIAPIPE_POSE
from signkin.io.registry import CONVERTED, METRES_PER
from signkin.joints import HANDS
from signkin.kinematics.noise import measure_noise
from signkin.kinematics.plausibility import LIMITS
from signkin.recording import Recording
from signkin.settings.text import yaml_value
from signkin.survey.skeletons import joint_map

# Formats by suffix, tried in order: the first that reads the file is taken.
MOTION: dict[str, tuple[str, ...]] = {
    ".bvh": ("bvh",), ".c3d": ("c3d",), ".trc": ("trc",), ".pose": ("pose",), ".tsd": ("tsd",),
    ".npy": ("npy",), ".npz": ("npy",), ".h5": ("deeplabcut_h5",),
    ".csv": ("vicon_csv", "motive_csv", "deeplabcut_csv", "mediapipe_csv", "openpose_csv", "csv"),
    ".tsv": ("qualisys_tsv", "csv"),
}  # fmt: skip
TAGS: dict[str, tuple[str, ...]] = {
    ".eaf": ("eaf",), ".textgrid": ("textgrid",), ".srt": ("srt",), ".vtt": ("vtt",),
}  # fmt: skip
SIGN_TIER = re.compile(r"gloss|glose|sign|lexem|gebärde|word|right|_r\b|manual", re.IGNORECASE)
SENTENCE_TIER = re.compile(r"utter|sentence|phrase|satz|énonc|clause|turn", re.IGNORECASE)
TRANSLATION_TIER = re.compile(r"transl|übersetz|traduc|english|deutsch|français", re.IGNORECASE)
TRIED = 3  # files of a format, of which one may be damaged
RATE_HZ = 100.0  # only to be able to read; asked for
# What a reader may want to be told, with a value to read by; the order is that of trying.
GUESSES: dict[str, Any] = {
    "image_size": [1280, 720], "incomplete": True, "rate_hz": RATE_HZ, "unit": "m",
}  # fmt: skip


@dataclass
class Start:
    """What was found out of a folder. lines: corpus.yaml. recordings: recordings.csv.
    signs: signs.csv, empty where there are no tags.
    asked: what a person has to say, a sentence each."""

    name: str
    lines: list[str] = field(default_factory=list)
    recordings: str = ""
    signs: str = ""
    asked: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """Return corpus.yaml."""
        return "\n".join(self.lines) + "\n"

    def ask(self, line: str, question: str) -> None:
        """Add a line that a person must look at, with the question above it."""
        self.asked.append(question)
        indent = line[: len(line) - len(line.lstrip())]
        self.lines += [f"{indent}# ASK: {question}", line]


def start(folder: Path, name: str) -> Start:
    """Return the description of the corpus in a folder. Raises SignkinError where no motion is."""
    files = sorted(p for p in folder.rglob("*") if p.is_file() and not p.name.startswith("."))
    motion, format, probe = _motion(files, folder)
    sample = probe.recording
    columns = table_joints(motion[0]) if format == "csv" else {}
    tags, tag_format = _tags(files, motion)
    out = Start(name)
    out.lines.append(f"# Made by `signkin corpus init {folder}`; lines below ASK want an answer.")
    title = yaml_value(name.replace("-", " ").replace("_", " "))
    out.ask(f"title: {title}", "title, language, licence and citation, for reports")
    out.lines += [f"{key}: unknown" for key in ("language", "licence", "citation")]
    out.lines.append(f"data_folder: {yaml_value(folder.name)}")
    known = joint_map(sample.joints)
    _noise(out, sample, known)
    _motion_section(out, format, probe, known, columns)
    if tags:
        tiers = _tag_section(out, tag_format, list(tags.values()))
        out.signs = signs_table(tag_format, list(tags.values()), tiers)
    out.recordings = _recordings(folder, motion, tags)
    lone = [m.name for m in motion if tags and m not in tags]
    if lone:
        out.asked.append(
            f"{len(lone)} of {len(motion)} motion files have no annotation of their name and are "
            f"left out of recordings.csv: {listed(lone, 5)}"
        )
    out.asked.append("who signs in each recording? (column `signer` of recordings.csv)")
    return out


def _motion(files: Sequence[Path], folder: Path) -> tuple[list[Path], str, Probe]:
    """Return the motion files of the commonest suffix that can be read, their format, and one."""
    counts = Counter(p.suffix.lower() for p in files if p.suffix.lower() in MOTION)
    said: list[str] = []
    for suffix, _ in counts.most_common():
        some = [p for p in files if p.suffix.lower() == suffix]
        for format in MOTION[suffix]:
            for path in some[:TRIED]:
                try:
                    return some, format, _probe(path, format)
                except SignkinError as error:
                    said.append(f"{format}: {error}")
    raise SignkinError(
        f"no motion that can be read{'; the last try: ' + said[-1] if said else ''}",
        file=folder,
        expected=f"files of {listed(MOTION, 20)}",
        todo=next(
            (CONVERTED[p.suffix.lower()] for p in files if p.suffix.lower() in CONVERTED),
            "docs/adding-a-corpus.md tells every format and its options.",
        ),
    )


@dataclass(frozen=True)
class Probe:
    """A file as it stands: its own axes, its own unit as if it were metres.

    guessed: what had to be declared to read it, which a person must confirm.
    """

    recording: Recording
    guessed: Mapping[str, Any]


def _probe(path: Path, format: str) -> Probe:
    """Read a file, declaring what its reader asks for: a rate, a unit, the image's size."""
    spec: dict[str, Any] = {}
    if format == "csv":
        spec["joints"] = table_joints(path)
    if format == "pose":
        spec["joints"] = _world_joints()
    if format == "npy":
        return _probe_landmarks(path, format)
    try:
        probe = _read_as_asked(path, format, spec)
    except SignkinError as error:
        if format != "pose" or error.place != "joints":
            raise
        return _read_as_asked(path, format, {})
    if format == "pose":
        named = tuple(spec["joints"][joint] for joint in probe.recording.joints)
        return replace(probe, recording=replace(probe.recording, joints=named))
    return probe


def _probe_landmarks(path: Path, format: str) -> Probe:
    """Read key points without names; as many as a tracker gives are taken for that tracker's."""
    probe = _read_as_asked(path, format, {})
    count = len(probe.recording.joints)
    fits = [name for name, landmarks in LISTS.items() if len(landmarks) == count]
    if not fits:
        return probe
    # Two hands' lists are of one length: the first is as good for the names of wrist and fingers.
    named = _read_as_asked(path, format, {"landmarks": fits[0]})
    return replace(named, guessed={"landmarks": fits[0], **named.guessed})


def _read_as_asked(path: Path, format: str, spec: Mapping[str, Any]) -> Probe:
    guessed: dict[str, Any] = {}
    while True:
        try:
            return Probe(read_recording(path, format=format, **spec, **guessed), guessed)
        except SignkinError as error:
            more = _wanted(error, guessed)
            if not more:
                raise
            guessed |= more


def _wanted(error: SignkinError, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a reader's error asks for and has not been given yet; empty where it is else."""
    told = f"{error.place} {error.found} {error.todo}"
    if "clock: first_frame" in told and "clock" not in given:
        return {"clock": "first_frame"}
    steps = re.search(r"steps of (\S+) to (\S+) s", error.found)
    if steps and "resample_hz" in told and "resample_hz" not in given:
        rate = float(f"{2 / (float(steps[1]) + float(steps[2])):.3g}")
        column = re.search(r"\{time_column: ([^}]+)\}", told)
        return {"resample_hz": rate, **({"time_column": column[1]} if column else {})}
    said = re.search(r"the file says ([0-9.]+) Hz", error.found)
    if said and given.get("rate_hz") == RATE_HZ:
        return {"rate_hz": float(said[1])}
    for name, value in GUESSES.items():
        if name in told and name not in given:
            return {name: value}
    if error.place == "unit" and given.get("unit") == "m":
        return {"unit": "px"}
    return {}


def _world_joints() -> dict[str, str]:
    """Return the joints of .pose files with MediaPipe's world landmarks."""
    hands = [f"{s}_HAND_LANDMARKS.{n}" for s in ("LEFT", "RIGHT") for n in MEDIAPIPE_HAND[1:]]
    return joint_map([*(f"POSE_WORLD_LANDMARKS.{name}" for name in MEDIAPIPE_POSE), *hands])


def table_joints(path: Path) -> dict[str, list[str]]:
    """Return the columns of each point of a table: names that differ in x, y, z alone."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        head = file.readline()
    separator = max(",;\t", key=head.count)
    points: dict[str, list[str]] = {}
    for column in next(csv.reader(io.StringIO(head), delimiter=separator), []):
        match = re.fullmatch(r"(.+?)[ _.:-]?([xyzXYZ])", column.strip())
        if match:
            points.setdefault(match[1], []).append(column.strip())
    points = {name: columns for name, columns in points.items() if len(columns) in (2, 3)}
    if len(points) < 2:
        raise SignkinError(
            "no columns that are points", file=path, place="line 1",
            expected="names such as right_wrist_x, right_wrist_y",
        )  # fmt: skip
    return points


def _tags(files: Sequence[Path], motion: Sequence[Path]) -> tuple[dict[Path, Path], str]:
    """Return motion file -> annotation of the same stem, and the annotations' format."""
    for suffix, formats in TAGS.items():
        by_stem = {p.stem: p for p in files if p.suffix.lower() == suffix}
        found = {m: by_stem[m.stem] for m in motion if m.stem in by_stem}
        if not found and len(by_stem) == len(motion) == 1:
            found = {motion[0]: next(iter(by_stem.values()))}
        if found:
            return found, formats[0]
    return {}, ""


def _noise(out: Start, sample: Recording, known: Mapping[str, str]) -> None:
    pair = [known[f"{hand}_wrist"] for hand in HANDS if f"{hand}_wrist" in known]
    scale = METRES_PER.get(_unit(sample, known)[0], 1.0)
    try:
        measured = measure_noise(sample, pair).sd * scale if pair else 0.0
    except SignkinError:
        measured = 0.0
    if measured > 0:
        out.lines += [
            f"noise_sd: {measured:.2g} # measured: third differences of the wrists of one file",
            'noise_source: "measured: third differences of the wrists\' positions"',
        ]
    else:
        out.ask("noise_sd: 0.001", "noise of the device in metres (px for images): not measurable")


def _motion_section(
    out: Start, format: str, probe: Probe, known: Mapping[str, str],
    columns: Mapping[str, list[str]],
) -> None:  # fmt: skip
    sample, guessed = probe.recording, probe.guessed
    out.lines += ["motion:", f"  format: {format}"]
    unit, why = _unit(sample, known)
    if why.startswith("ASK") and "unit" in guessed:
        out.ask(f"  unit: {unit}", f"unit of length{why.removeprefix('ASK')}")
    elif unit == "px" or "unit" in guessed:
        out.lines.append(f"  unit: {unit} # {why}")
    if "rate_hz" in guessed:
        rate = guessed["rate_hz"]
        question = "sampling rate in Hz, which the files do not tell"
        if rate != RATE_HZ:
            question = f"sampling rate in Hz: the files say {rate:g}, which may be rounded"
        out.ask(f"  rate_hz: {rate:g}", question)
    for key, axis, ground in _axes(sample, known):
        out.lines.append(f"  {key}: {axis} # {ground}")
    _options(out, guessed)
    missing = [f"{hand}_wrist" for hand in HANDS if f"{hand}_wrist" not in known]
    recorded = sample.orientations is not None
    out.lines.append(f"  orientations: {'recorded' if recorded else 'none'}")
    if missing:
        whole = "; leave it out where one hand was recorded" if len(missing) == 1 else ""
        out.asked.append(f"which names are {' and '.join(missing)}{whole}?")
        out.lines.append(f"  # ASK: which of these are {' and '.join(missing)}?")
        out.lines.append(f"  # {listed(sample.joints, 60)}")
    out.lines.append("  joints:" if known else "  joints: {}")
    for joint, name in known.items():
        out.lines.append(f"    {joint}: {yaml_value(columns.get(name, name))}")


def _options(out: Start, guessed: Mapping[str, Any]) -> None:
    """Write the options of the format that had to be declared."""
    asked = {
        "image_size": "size of the video's image in pixels, [width, height]",
        "incomplete": "the files have fewer frames than they say: is that meant?",
        "clock": "the files' times do not start at 0: do tags count from the first frame?",
        "resample_hz": "the files' times are uneven; the rate to resample them to",
        "landmarks": "whose landmarks are these? (by their number)",
        "time_column": "",
    }
    wanted = [name for name in asked if name in guessed]
    if wanted:
        out.lines.append("  options:")
    for name in wanted:
        line = f"    {name}: {yaml_value(guessed[name])}"
        if asked[name]:
            out.ask(line, asked[name])
        else:
            out.lines.append(line)


def _unit(sample: Recording, known: Mapping[str, str]) -> tuple[str, str]:
    """Return the unit in which limbs have a body's lengths, and the ground."""
    if sample.unit == "px":
        return "px", "the file says so"
    lengths = []
    for hand in HANDS:
        ends = [known.get(f"{hand}_{part}") for part in ("elbow", "wrist")]
        if None not in ends:
            a, b = (sample.track(str(end)) for end in ends)
            lengths.append(float(np.nanmedian(np.linalg.norm(a - b, axis=1))))
    if not lengths:
        return "m", "ASK: no elbows to measure a forearm by; m, cm, mm, inch, ft or px?"
    forearm, limit = float(np.median(lengths)), LIMITS["forearm"]
    fits = [u for u, f in METRES_PER.items() if limit.low <= forearm * f <= limit.high]
    if fits:
        return fits[0], f"the forearm is then {forearm * METRES_PER[fits[0]]:.2f} m"
    return "m", f"ASK: in no unit is the forearm ({forearm:.3g} units) one; metres a unit, or px?"


def _axes(sample: Recording, known: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    """Yield up and right, by where head and shoulders are."""
    seen = np.array([1, 1, 0 if sample.unit == "px" else 1])  # an image's depth is an estimate
    tops = [known[j] for j in ("head", "nose", "neck", "right_shoulder") if j in known]
    bottoms = [known[j] for j in ("pelvis", "right_hip", "right_knee") if j in known]
    if tops and bottoms:
        axis = _axis((sample.track(tops[0]) - sample.track(bottoms[0])) * seen)
        yield "up", axis, f"from {bottoms[0]} to {tops[0]}"
    elif tops and "right_wrist" in known:
        axis = _axis((sample.track(tops[0]) - sample.track(known["right_wrist"])) * seen)
        yield "up", axis, f"from {known['right_wrist']} to {tops[0]}: hands are mostly lower"
    elif sample.unit == "px":
        yield "up", "-y", "images are counted from the top"
    for part in ("shoulder", "hip", "wrist"):
        right, left = (known.get(f"{hand}_{part}") for hand in HANDS)
        if right and left:
            axis = _axis((sample.track(right) - sample.track(left)) * seen)
            yield "right", axis, f"from {left} to {right}"
            return


def _axis(vector: NDArray[np.float64]) -> str:
    middle = np.nanmedian(vector, axis=0)
    largest = int(np.argmax(np.abs(middle)))
    return ("-" if middle[largest] < 0 else "") + "xyz"[largest]


def signs_table(format: str, files: Sequence[Path], tiers: Sequence[str]) -> str:
    """Return signs.csv: the glosses of tiers that may hold signs, the commonest first.

    Their types are left empty, which is a question; the column source says where they stand.
    """
    counts: Counter[str] = Counter()
    where: dict[str, Counter[str]] = {}
    for path in files:
        try:
            annotation = read_annotation(path, format=format)
        except SignkinError:
            continue  # `check` tells of it
        for interval in annotation.intervals:
            gloss = " ".join(interval.label.split())
            if gloss and interval.tier in tiers:
                counts[gloss] += 1
                where.setdefault(gloss, Counter())[interval.tier] += 1
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["gloss", "hands", "symmetric", "source"])
    for gloss, _ in counts.most_common():
        told = ", ".join(f"{tier}: {n}" for tier, n in where[gloss].most_common())
        writer.writerow([gloss, "", "", f"ASK: its type? {told}"])
    return text.getvalue()


def _tag_section(out: Start, format: str, files: Sequence[Path]) -> list[str]:
    """Describe the tiers of the first annotation, choose by name and length; return the signs'.

    Where no name tells the tier of the signs, those that are no sentences and translations are.
    """
    annotation = read_annotation(files[0], format=format)
    tiers = {t: [i.end_s - i.start_s for i in annotation.tier(t)] for t in annotation.tiers}
    signs = sorted(
        tiers, key=lambda t: (not SIGN_TIER.search(t), bool(SENTENCE_TIER.search(t)),
                              bool(TRANSLATION_TIER.search(t)), -len(tiers[t])),
    )  # fmt: skip
    out.lines += ["annotation:", f"  format: {format}"]
    told = "; ".join(
        f"{t}: {len(tiers[t])} of {float(np.median(tiers[t])):.2f} s" for t in signs[:12]
    )
    out.ask(f"  sign_tier: {yaml_value(signs[0])}", f"the tier of the signs? There are {told}")
    rest = signs[1:]
    sentences = [t for t in rest if SENTENCE_TIER.search(t)]
    if sentences:
        out.lines.append(f"  utterance_tier: {yaml_value(sentences[0])} # by its name")
    else:
        out.lines.append("  utterance_gap_s: 1.0 # no tier of sentences: a longer pause ends one")
    translations = [t for t in rest if TRANSLATION_TIER.search(t)]
    if translations:
        out.lines.append(f"  translation_tier: {yaml_value(translations[0])} # by its name")
    named = [tier for tier in signs if SIGN_TIER.search(tier)]
    return [t for t in named or signs if t not in (*sentences, *translations)] or signs[:1]


def _recordings(folder: Path, motion: Sequence[Path], tags: Mapping[Path, Path]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["recording", "signer", "motion", *(["annotation"] if tags else [])])
    for path in motion:
        if tags and path not in tags:
            continue
        name = re.sub(r"[^A-Za-z0-9._-]+", "-", path.relative_to(folder).with_suffix("").as_posix())
        row = [name, "signer-1", path.relative_to(folder).as_posix()]
        writer.writerow([*row, *([tags[path].relative_to(folder).as_posix()] if tags else [])])
    return text.getvalue()
