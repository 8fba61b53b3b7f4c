"""corpus.yaml as a model: what a corpus says of itself, and how its files are read."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from signkin.settings.annotation import Annotation
from signkin.settings.base import Hertz, Positive, Section, key

Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
Seconds = Annotated[float, Field(ge=0)]
Text = Annotated[str, Field(min_length=1)]
Columns = Annotated[tuple[Text, ...], Field(min_length=2, max_length=3, strict=False)]
Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
WebAddress = Annotated[str, Field(pattern="^https?://[^ ]+$")]


MotionFormat = Literal[
    "bvh", "c3d", "csv", "deeplabcut_csv", "deeplabcut_h5", "kinect", "kinect_v2",
    "mediapipe_csv", "motive_csv", "npy", "openpose_csv", "openpose_json", "pose", "qualisys_tsv",
    "trc", "tsd", "vicon_csv",
]  # fmt: skip
Unit = Literal["m", "cm", "mm", "inch", "ft", "px"] | Positive


class OverruledRate(Section):
    """A rate instead of the one that the files tell."""

    use: Hertz = key(text="The right rate.", unit="Hz")
    instead_of_file: Literal[True] = key(text="That it is meant.")


class Motion(Section):
    """How motion files are read."""

    format: MotionFormat = key(
        text="Format of the motion files: a reader of docs/adding-a-corpus.md, Motion formats."
    )
    unit: (
        Unit
        | Annotated[tuple[Unit, ...], Field(min_length=3, max_length=3, strict=False)]
        | None
    ) = key(
        None, "Unit of length in the files, where they do not tell it, or metres a unit; px for "
        "image coordinates; a list of three, one an axis of the file.",
    )  # fmt: skip
    rate_hz: Hertz | OverruledRate | None = key(
        None, "Sampling rate, where the files do not tell it; `{use: 60, instead_of_file: true}` "
        "where they tell it wrongly.", unit="Hz",
    )  # fmt: skip
    up: Axis | None = key(None, "The file's axis that points up.")
    right: Axis | None = key(None, "The file's axis that points to the signer's right.")
    joints: dict[str, Text | Columns] = key(
        text="Canonical joint name -> name in the file (csv: list of columns); both wrists, "
        "or the one of a one-handed recording, at least.", min_length=1,
    )  # fmt: skip
    orientations: Literal["recorded", "limb_frames", "none"] = key(
        "none", "`recorded` (from the file), `limb_frames` (made from positions) or `none`."
    )
    options: dict[str, Any] = key(
        {}, "What the format's reader wants to know besides (docs/adding-a-corpus.md)."
    )


class FoundSign(Section):
    """The sign of a recording without tags."""

    gloss: Text = key(text="Its gloss.")
    start_s: Seconds | None = key(None, "Where it starts; by rule where missing.", unit="s")
    end_s: Positive | None = key(None, "Where it ends; with start_s.", unit="s")

    @model_validator(mode="after")
    def _both_ends(self) -> FoundSign:
        if (self.start_s is None) != (self.end_s is None):
            raise ValueError("start_s and end_s together, or neither")
        return self


class Idle(Section):
    """The idle posture."""

    recording: Text = key(text="The recording it is taken from.")
    time_s: Seconds = key(text="When in it.", unit="s")


class CorpusSynthesis(Section):
    """What synthesis wants to know of a corpus."""

    signs: dict[str, FoundSign] = key({}, "Recording without tags -> its sign.")
    idle: Idle | None = key(None, "The idle posture.")


class Example(Section):
    """An excerpt for a figure of speeds."""

    recording: Text = key(text="The recording.")
    from_s: Seconds = key(text="Where it starts.", unit="s")
    to_s: Positive = key(text="Where it ends.", unit="s")


class Examples(Section):
    """Excerpts for the speed figures; where missing they are chosen by rule."""

    fig04: Example | None = key(None, "For Fig. 4.")
    fig05: Example | None = key(None, "For Fig. 5.")
    fig06: Example | None = key(None, "For Fig. 6.")


def _plain_name(name: str) -> str:
    if name in (".", "..") or "/" in name or "\\" in name:
        raise ValueError("a name without slashes: a folder right below data_dir")
    return name


def _inside(name: str) -> str:
    if not name or name.startswith("/") or "\\" in name or ".." in name.split("/"):
        raise ValueError("the name of a file in the data folder, without ..")
    return name


class CorpusDescription(Section):
    """What a corpus says of itself."""

    title: str = key(text="Title, as reports show it.")
    language: str = key(text="The sign language.")
    description: str = key("", "What was recorded, how, with whom.")
    licence: str = key(text="Licence of the recordings.")
    citation: str = key(text="How to cite it.")
    simulator: Literal["lsf-sim", "isl-sim", "signkin simulate"] | None = key(
        None, "What makes this corpus: a rule of the run, or `signkin simulate`, whose files lie "
        "with its description; leave it out for real recordings."
    )  # fmt: skip
    data_folder: Annotated[Text, AfterValidator(_plain_name)] | None = key(
        None, "Folder of the recordings below data_dir; the corpus's own name where missing."
    )
    checksums: dict[str, Sha256] = key({}, "SHA-256 of data files by name.")
    downloads: dict[Annotated[str, AfterValidator(_inside)], WebAddress] = key(
        {}, "Public address of data files by name, for `make fetch`; each with its checksum."
    )
    on_error: Literal["stop", "skip"] = key(
        "stop", "`stop`, or `skip`: a recording that fails is left out and listed."
    )
    noise_sd: Positive = key(
        text="Standard deviation of the recording device's noise, in m (px for image corpora)."
    )
    noise_source: str | None = key(None, "Where noise_sd comes from.")
    truth_file: str | None = key(None, "Table of true boundaries in the data folder.")
    motion: Motion = key(text="How motion files are read.")
    left_handed: Annotated[tuple[Text, ...], Field(strict=False)] = key(
        (), "Signers whose dominant hand is the left one."
    )
    tagged_hand: Literal["right", "left"] | None = key(
        None, "The hand that the tags of signs are of, where one tier has those of one hand alone: "
        "they are held against this hand's speed minima.",
    )  # fmt: skip
    annotation: Annotation | None = key(
        None, "How annotation files are read; without it the corpus has no tags."
    )
    synthesis: CorpusSynthesis = CorpusSynthesis()
    examples: Examples = Examples()

    @model_validator(mode="after")
    def _verifiable(self) -> CorpusDescription:
        if without := [name for name in self.downloads if name not in self.checksums]:
            raise ValueError(f"downloads: {without[0]} has no SHA-256 under checksums")
        return self
