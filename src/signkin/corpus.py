"""A corpus as a folder: corpus.yaml, recordings.csv, signs.csv, checked before anything runs.

JSON Schemas (signkin/schemas) check shapes and words; this module adds what
schemas cannot say: doubled rows, files that are not there, joint names outside
the vocabulary, sign types that contradict themselves.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import yaml

from signkin import joints as joint_names
from signkin.annotation import TierWish, tier_key
from signkin.corpus_tiers import filled, is_by_hand
from signkin.errors import SignkinError, listed
from signkin.owner_rows import read_owner_table
from signkin.settings.checks import checked
from signkin.settings.corpus import CorpusDescription
from signkin.shared_files import check_doubled, check_shared_tables, check_shared_tags
from signkin.yaml_file import read_yaml

SCHEMAS = files("signkin") / "schemas"
GUIDE = "See docs/adding-a-corpus.md."


@dataclass(frozen=True)
class Entry:
    """A row of recordings.csv: one recording and where its files lie in the data folder.

    sign, repetition: the gloss of a recording that holds one sign and the number of this
    repetition, from 1; empty and None for a recording of continuous signing.
    from_s, to_s: the stretch of the annotation's time that the recording is, where the
    annotation is that of a longer one; clock_offset_s: added to the annotation's times besides.
    rating, rating_note: what the owner thinks of it (`signkin.ratings`).
    """

    recording: str
    signer: str
    motion: str
    annotation: str
    part: str
    line: int
    sign: str = ""
    repetition: int | None = None
    from_s: float = 0.0
    to_s: float | None = None
    clock_offset_s: float = 0.0
    rating: str = ""
    rating_note: str = ""


@dataclass(frozen=True)
class SignType:
    """A row of signs.csv (Naert et al. 2017, section 5.1).

    hands: 0 one hand, 1 two hands, 2 one hand while the other keeps the context.
    symmetric: 1 where the two hands move symmetrically (two-handed signs only).
    """

    gloss: str
    hands: int
    symmetric: int

    @property
    def digits(self) -> str:
        """The two digits of the type, `10`."""
        return f"{self.hands}{self.symmetric}"


@dataclass(frozen=True)
class Corpus:
    """A checked corpus. `settings` is corpus.yaml as it stands."""

    name: str
    folder: Path
    settings: Mapping[str, Any]
    entries: tuple[Entry, ...]
    signs: tuple[SignType, ...]

    @property
    def simulator(self) -> str | None:
        """Name of the simulator that makes the corpus, None for real recordings."""
        return self.settings.get("simulator")

    @property
    def made_by_run(self) -> bool:
        """Whether a rule of the run writes the recordings; no files are there before."""
        return self.simulator in ("lsf-sim", "isl-sim")

    @property
    def tagged(self) -> bool:
        """Whether the corpus has sign tags, which Naert et al.'s analyses need."""
        return "annotation" in self.settings

    @property
    def single_signs(self) -> bool:
        """Whether every recording holds one sign, which Endres et al.'s analyses need."""
        return all(entry.sign for entry in self.entries)

    @property
    def skips(self) -> bool:
        """Whether a recording that cannot be used is left out instead of ending the run."""
        return bool(self.settings.get("on_error", "stop") == "skip")

    @property
    def noise_sd(self) -> float:
        """Standard deviation of the device's noise in the unit after reading (m or px)."""
        return float(self.settings["noise_sd"])

    @cached_property
    def by_name(self) -> Mapping[str, Entry]:
        """The rows of recordings.csv by the recording's name."""
        return {entry.recording: entry for entry in self.entries}

    @property
    def unit(self) -> str:
        """Unit of length after reading: m or px."""
        return "px" if self.settings["motion"].get("unit") == "px" else "m"

    @property
    def declared_rate_hz(self) -> float | None:
        """The sampling rate that corpus.yaml states, None where the files tell it."""
        rate = self.settings["motion"].get("rate_hz")
        return float(rate) if isinstance(rate, (int, float)) else None

    @property
    def lexicon(self) -> dict[str, str]:
        """Two digits of each gloss of signs.csv."""
        return {sign.gloss: sign.digits for sign in self.signs}

    def motion_spec(self, entry: Entry) -> dict[str, Any]:
        """Return the arguments of `read_recording` for one recording."""
        motion = dict(self.settings["motion"])
        motion.pop("orientations", None)
        options = motion.pop("options", {})
        return {**motion, **options, "name": entry.recording, "part": entry.part or None}

    def annotation_spec(self, entry: Entry) -> dict[str, Any]:
        """Return the arguments of `read_annotation` for one recording."""
        annotation = self.settings["annotation"]
        wishes = {tier_key(w): w for own in self.tiers_of(entry).values() for w in own.values()}
        return {
            "format": annotation.get("format"),
            "tiers": tuple(wishes.values()),
            "name": entry.recording,
            "part": entry.part or None,
            "gloss": annotation.get("gloss"),
            "from_s": entry.from_s,
            "to_s": entry.to_s,
            "clock_offset_s": entry.clock_offset_s,
            **annotation.get("options", {}),
        }

    @property
    def tiers(self) -> dict[str, Any]:
        """Tiers of each role: sign, and utterance and translation where the corpus names them."""
        annotation = self.settings.get("annotation", {})
        out = {"sign": annotation.get("sign_tiers") or annotation.get("sign_tier")}
        for role in ("utterance", "translation"):
            out[role] = annotation.get(f"{role}_tier")
        return {role: wanted for role, wanted in out.items() if wanted}

    def tiers_of(self, entry: Entry) -> dict[str, dict[str, TierWish]]:
        """Return, for each role, the tiers of one recording by hand (`both` where none is told).

        `{signer}`, `{recording}` and `{part}` in a name stand for the recording's own.
        """
        out: dict[str, dict[str, TierWish]] = {}
        for role, wanted in self.tiers.items():
            by_hand = wanted if is_by_hand(wanted) else {"both": wanted}
            out[role] = {hand: filled(wish, entry) for hand, wish in by_hand.items()}
        return out

    def dominant_hand(self, entry: Entry) -> str:
        """Return `left` for signers whom the corpus calls left-handed, else `right`."""
        return "left" if entry.signer in self.settings.get("left_handed", ()) else "right"

    def files(self) -> list[str]:
        """Return the data files of all recordings, each once, in order."""
        names = [n for e in self.entries for n in (e.motion, e.annotation) if n]
        return list(dict.fromkeys([*names, *self.annotator_files()]))

    @property
    def annotators(self) -> dict[str, dict[str, Any]]:
        """Where the signs of further annotators are, by annotator."""
        return dict(self.settings.get("annotation", {}).get("annotators", {}))

    def annotator_file(self, entry: Entry, annotator: str) -> str:
        """Return the file with an annotator's tags of a recording."""
        wish = self.annotators[annotator].get("file")
        return entry.annotation if wish is None else str(filled(wish, entry))

    def annotator_files(self) -> list[str]:
        """Return the files of further annotators, each once."""
        return list(dict.fromkeys(
            self.annotator_file(e, name) for name in self.annotators for e in self.entries
        ))  # fmt: skip

    def annotator_spec(self, entry: Entry, annotator: str) -> dict[str, Any]:
        """Return the arguments of `read_annotation` for an annotator's tags of a recording."""
        tier = self.annotators[annotator].get("tier", self.settings["annotation"].get("sign_tier"))
        wishes = () if tier is None else (filled(tier, entry),)
        return {**self.annotation_spec(entry), "tiers": wishes}


def load_corpora(folder: Path, names: list[str] | None = None) -> dict[str, Corpus]:
    """Load and check the corpora of a folder, all or those named, by name."""
    if not folder.is_dir():
        raise SignkinError("there is no such folder", file=folder, todo="Set corpora_dir.")
    there = sorted(path.name for path in folder.iterdir() if (path / "corpus.yaml").is_file())
    unknown = sorted(set(names or ()) - set(there))
    if unknown:
        raise SignkinError(
            f"no corpus {listed(unknown)}", file=folder, expected=listed(there), todo=GUIDE
        )
    return {name: load_corpus(folder / name) for name in (there if names is None else names)}


def load_corpus(folder: Path) -> Corpus:
    """Load and check one corpus folder."""
    settings = _given(read_yaml(folder / "corpus.yaml", GUIDE))
    checked(CorpusDescription, settings, folder / "corpus.yaml", hint=GUIDE)
    _check_joints(settings["motion"], folder / "corpus.yaml")
    entries = tuple(_read_entries(folder / "recordings.csv", tagged="annotation" in settings))
    signs_file = folder / "signs.csv"
    signs = tuple(_read_signs(signs_file)) if signs_file.exists() else ()
    corpus = Corpus(folder.name, folder, settings, entries, signs)
    check_doubled(corpus, folder / "recordings.csv")
    check_shared_tables(corpus, folder / "recordings.csv")
    check_shared_tags(corpus, folder / "recordings.csv")
    return corpus


def _given(content: dict[str, Any]) -> dict[str, Any]:
    """Return a mapping without the keys that are null, which say the same as none."""
    inner = {k: _given(v) if isinstance(v, dict) else v for k, v in content.items()}
    return {k: v for k, v in inner.items() if v is not None}


def check_schema(content: object, schema: str, file: Path | str, place: str = "") -> None:
    """Check a value against signkin/schemas/<schema>.schema.yaml; the error names the key."""
    errors = sorted(_validator(schema).iter_errors(content), key=lambda e: list(map(str, e.path)))
    if not errors:
        return
    error = jsonschema.exceptions.best_match(errors)
    assert error is not None
    key = ".".join(str(part) for part in error.absolute_path)
    places = [part for part in (place, f"key {key}" if key else "") if part]
    rule = error.schema if isinstance(error.schema, dict) else {}
    raise SignkinError(
        error.message,
        file=file,
        place=", ".join(places) or None,
        expected=rule.get("description"),
        todo=GUIDE if schema != "config" else "config.yaml tells each key's unit and meaning.",
    )


@cache
def _validator(schema: str) -> jsonschema.Draft202012Validator:
    path = SCHEMAS / f"{schema}.schema.yaml"
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(content)
    return jsonschema.Draft202012Validator(content)


def _holds(row: Mapping[str, str], schema: str) -> bool:
    """Return whether a row of text surely holds to a schema, at a tenth of the cost of its errors.

    Each job reads all rows of a corpus; a row that fails here is for `check_schema` to judge.
    """
    rules: Any = _validator(schema).schema
    properties = rules["properties"]
    if not all(name in row for name in rules["required"]):
        return False
    for name, value in row.items():
        rule = properties.get(name)
        if rule is None or not isinstance(value, str) or len(value) < rule.get("minLength", 0):
            return False
        if "pattern" in rule and not re.search(rule["pattern"], value):
            return False
        if "enum" in rule and value not in rule["enum"]:
            return False
    return True


def _check_joints(motion: Mapping[str, Any], file: Path) -> None:
    for joint in motion["joints"]:
        if not joint_names.is_known(joint):
            raise SignkinError(
                f"the joint {joint!r} is not in the vocabulary",
                file=file,
                place="key motion.joints",
                expected=joint_names.vocabulary(),
            )
    if not joint_names.hands_of(motion["joints"]):
        raise SignkinError(
            "no joint right_wrist and no joint left_wrist",
            file=file,
            place="key motion.joints",
            expected="both wrists, or one of a one-handed recording: every analysis needs one",
        )


def _rows(path: Path, schema: str, key: str) -> Iterator[tuple[int, dict[str, str]]]:
    """Yield (line, row) of a checked CSV file; a doubled key is an error."""
    try:
        table = read_owner_table(path, as_written=("gloss", "sign"))
    except FileNotFoundError:
        raise SignkinError("there is no such file", file=path, todo=GUIDE) from None
    seen: dict[str, int] = {}
    for line, row in table.rows:
        if not _holds(row, schema):
            check_schema(row, schema, path, f"line {line}")
        if row[key] in seen:
            raise SignkinError(
                f"{key} {row[key]!r} stands in line {seen[row[key]]} already",
                file=path,
                place=f"line {line}",
                expected="each once",
                todo="Take one of the two rows out.",
            )
        seen[row[key]] = line
        yield line, row


def _read_entries(path: Path, tagged: bool) -> Iterator[Entry]:
    count = 0
    repetitions: dict[tuple[str, str, int], int] = {}
    for line, row in _rows(path, "recordings", "recording"):
        count += 1
        if tagged and not row.get("annotation"):
            raise SignkinError(
                "no annotation file",
                file=path,
                place=f"line {line}",
                expected="one for each recording, since corpus.yaml has an annotation section",
            )
        sign = row.get("sign", "")
        from_s = float(row.get("from_s") or 0)
        to_s = float(row["to_s"]) if row.get("to_s") else None
        if to_s is not None and to_s <= from_s:
            raise SignkinError(
                f"from_s {from_s:g}, to_s {to_s:g}",
                file=path,
                place=f"line {line}",
                expected="an end after the start",
            )
        repetition = int(row["repetition"]) if row.get("repetition") else None
        if repetition is not None:
            _check_repetition((row["signer"], sign, repetition), line, repetitions, path)
        yield Entry(
            recording=row["recording"],
            signer=row["signer"],
            motion=row["motion"],
            annotation=row.get("annotation", ""),
            part=row.get("part", ""),
            line=line,
            sign=sign,
            repetition=repetition,
            from_s=from_s,
            to_s=to_s,
            clock_offset_s=float(row.get("clock_offset_s") or 0),
            rating=row.get("rating", ""),
            rating_note=row.get("rating_note", ""),
        )
    if not count:
        raise SignkinError("no recording", file=path, expected="one row a recording", todo=GUIDE)


def _check_repetition(
    key: tuple[str, str, int], line: int, seen: dict[tuple[str, str, int], int], path: Path
) -> None:
    """Refuse a repetition of no sign, and one that a signer has of a sign already."""
    signer, sign, repetition = key
    if not sign:
        raise SignkinError(
            f"repetition {repetition} without a sign",
            file=path,
            place=f"line {line}",
            expected="the gloss in the column `sign`, or no repetition",
        )
    if key in seen:
        raise SignkinError(
            f"repetition {repetition} of {sign!r} by {signer} stands in line {seen[key]} already",
            file=path,
            place=f"line {line}",
            expected="each repetition of a signer's sign once",
        )
    seen[key] = line


def _read_signs(path: Path) -> Iterator[SignType]:
    """Yield the types; a gloss without one is a question, and typed from motion until it is told.

    Annotations are read with composed accents, too.
    """
    for line, row in _rows(path, "signs", "gloss"):
        if not row["hands"] and not row["symmetric"]:
            continue
        if not row["hands"] or not row["symmetric"]:
            raise SignkinError(
                f"{row['gloss']} has half a type",
                file=path,
                place=f"line {line}",
                expected="hands and symmetric, or neither",
            )
        hands, symmetric = int(row["hands"]), int(row["symmetric"])
        if symmetric and hands != 1:
            raise SignkinError(
                f"{row['gloss']} is symmetric with hands = {hands}",
                file=path,
                place=f"line {line}",
                expected="symmetric = 1 for two-handed signs (hands = 1) only",
            )
        yield SignType(row["gloss"], hands, symmetric)


# --- where the data lie ----------------------------------------------------------------------


def data_folder(corpus: Corpus, data_dir: str | Path | None, results: Path) -> Path | None:
    """Return the folder that holds a corpus's recordings, or None where they are not there.

    Corpora that the run makes lie in the results; others in `data_dir/<data_folder>`, or in
    the corpus's own folder `data`.
    """
    if corpus.made_by_run:
        return results / corpus.name / "simulated"
    name = corpus.settings.get("data_folder", corpus.name)
    candidates = [corpus.folder / "data"]
    if data_dir:
        candidates.insert(0, Path(data_dir) / name)
    return next((folder for folder in candidates if folder.is_dir()), None)


def data_dir_of(data_dir: str | None) -> str | None:
    """Return the folder of real recordings: the environment's SIGNKIN_DATA, else config.yaml's."""
    return os.environ.get("SIGNKIN_DATA") or data_dir or None
