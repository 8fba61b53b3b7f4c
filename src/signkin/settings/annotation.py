"""corpus.yaml's section `annotation` as a model: tiers, rules for glosses, options of formats."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, model_validator

from signkin.settings.base import Hertz, Positive, Section, key

Text = Annotated[str, Field(min_length=1)]
Texts = Annotated[tuple[Text, ...], Field(strict=False)]
Letter = Annotated[str, Field(min_length=1, max_length=1)]


class TierMatch(Section):
    """Tiers by what they have in common; one of the two keys at least."""

    pattern: Text | None = key(None, "The tiers' names; `*` and `?` stand for any letters.")
    participant: Text | None = key(None, "Whom the tiers belong to.")

    @model_validator(mode="after")
    def _one_at_least(self) -> TierMatch:
        if self.pattern is None and self.participant is None:
            raise ValueError("pattern or participant, or both")
        return self


Tier = Text | TierMatch


class SignTiers(Section):
    """Tiers of the signs by hand; one at least."""

    right: Tier | None = key(None, "Tier of the right hand's signs.")
    left: Tier | None = key(None, "Tier of the left hand's signs.")
    both: Tier | None = key(None, "Tier of two-handed signs.")

    @model_validator(mode="after")
    def _one_at_least(self) -> SignTiers:
        if self.right is None and self.left is None and self.both is None:
            raise ValueError("a tier for right, left or both")
        return self


class Annotator(Section):
    """Where a further annotator's signs are; one of the two keys at least."""

    file: Text | None = key(
        None, "Annotation file, with `{recording}`, `{part}` or `{signer}`; the recording's own "
        "if missing.",
    )  # fmt: skip
    tier: Tier | None = key(None, "Tier of this annotator's signs; sign_tier if missing.")

    @model_validator(mode="after")
    def _one_at_least(self) -> Annotator:
        if self.file is None and self.tier is None:
            raise ValueError("file or tier, or both")
        return self


class Gloss(Section):
    """How glosses are made from labels; the label as written is kept beside."""

    strip: Texts = key((), "Marks that are taken off both ends of a label.")
    merge: dict[str, Text] = key({}, "Gloss -> the gloss it counts as, after stripping.")


class EafOptions(Section):
    """Options of ELAN files."""

    unaligned: Literal["refuse", "interpolate"] = key("refuse", "Times that the file leaves open.")
    clock_media: Text | None = key(None, "The medium whose clock the motion shares.")
    time_units: Literal["milliseconds", "PAL-frames", "NTSC-frames"] | None = key(
        None, "What times are, where TIME_UNITS is not milliseconds."
    )


class TextOptions(Section):
    """Options of text files."""

    encoding: Text | None = key(None, "Where a file is neither UTF-8 nor UTF-16.")


class SrtOptions(TextOptions):
    """Options of SubRip files."""

    speaker_before_colon: bool = key(False, "`ANN: text` is a cue of the tier ANN.")


Names = Annotated[tuple[str, ...], Field(strict=False)]


class FrameLabelOptions(TextOptions):
    """Options of labels of frames."""

    rate_hz: Hertz | None = key(None, "Rate of the labels.", unit="Hz")
    frame_rate_hz: Hertz | None = key(None, "The same; the motion's if missing.", unit="Hz")
    recording_column: Text | None = key(None, "Column with the recording's `part`.")
    frame_column: Text | None = key(None, "Column with the frame's number.")
    first_frame: Annotated[int, Field(ge=0)] = key(0, "Number of the first frame.")
    header: bool = key(True, "Whether columns have names, which are tiers.")
    blank: Annotated[tuple[str, ...], Field(strict=False)] = key(("",), "Labels that are no sign.")
    separator: Letter | Literal["comma", "semicolon", "tab"] | None = key(
        None, "Between cells; found out where missing."
    )
    ignore: Names = key((), "Columns whose names mean something else here.")


class CsvOptions(TextOptions):
    """Options of tables of tags."""

    rate_hz: Hertz | None = key(None, "Rate of frame numbers.", unit="Hz")
    frame_rate_hz: Hertz | None = key(None, "The same; the motion's if missing.", unit="Hz")
    recording_column: Text | None = key(None, "Column with the recording's `part`.")
    start_column: Text = key("start", "Column of starts.")
    end_column: Text = key("end", "Column of ends.")
    duration_column: Text | None = key(None, "Column of durations, instead of ends.")
    label_column: Text = key("label", "Column of labels.")
    tier_column: Text | None = key(None, "Column of tiers.")
    participant_column: Text | None = key(None, "Column of participants.")
    time_unit: Literal["s", "ms", "frames", "timecode"] | None = key(None, "What times are; s.")
    end_inclusive: bool = key(False, "Whether the end is the last frame of the interval.")
    separator: Letter | Literal["comma", "semicolon", "tab"] | None = key(
        None, "Between cells; found out where missing."
    )
    ignore: Names = key((), "Columns whose names mean something else here.")
    decimal: Literal[".", ","] | None = key(None, "The decimal sign, where it is not plain.")


class ElanTabOptions(TextOptions):
    """Options of ELAN's tab-delimited text."""

    media_offset: Literal["added", "not_added"] | None = key(
        None, "Whether ELAN added a medium's offset to the times."
    )


class VttOptions(TextOptions):
    """Options of WebVTT."""

    timestamp_map: Literal["ignore"] | None = key(None, "Where cues count in a stream's clock.")


class C3dEventOptions(Section):
    """Options of events of C3D files."""

    start_event: Text | None = key(None, "Label of the events at which signs start.")
    end_event: Text | None = key(None, "Label of the events at which they end.")
    blank: Annotated[tuple[str, ...], Field(strict=False)] = key((), "Labels that end a sign.")
    event_clock: Literal["capture", "first_frame"] | None = key(
        None, "Where events count from, if the file does not start at frame 1."
    )
    header: Literal["check", "ignore"] = key("check", "Whether the header must agree.")
    encoding: Text = key("utf-8", "Of labels.")


OPTIONS: dict[str, type[Section]] = {
    "c3d_events": C3dEventOptions,
    "csv": CsvOptions,
    "eaf": EafOptions,
    "elan_tab": ElanTabOptions,
    "frame_labels": FrameLabelOptions,
    "srt": SrtOptions,
    "textgrid": TextOptions,
    "vtt": VttOptions,
}


class Annotation(Section):
    """How annotation files are read."""

    format: Literal[
        "c3d_events", "csv", "eaf", "elan_tab", "frame_labels", "srt", "textgrid", "vtt"
    ] = key(text="Format of the annotation files.")
    sign_tier: Tier | None = key(None, "Tier of the signs; or sign_tiers.")
    sign_tiers: SignTiers | None = key(None, "Tiers of the signs by hand.")
    utterance_tier: Tier | None = key(
        None, "Tier whose intervals are the utterances; or utterance_gap_s."
    )
    utterance_gap_s: Positive | None = key(
        None, "A pause longer than this ends an utterance (where no tier tells).", unit="s"
    )
    translation_tier: Tier | None = key(None, "Tier with translations, for Table 1.")
    annotators: dict[Text, Annotator] = key(
        {}, "Further annotators of the same signing, by name; the page of the corpus shows how far "
        "they agree.",
    )  # fmt: skip
    gloss: Gloss | None = key(None, "Rules for glosses.")
    options: dict[str, Any] = key(
        {}, "What the format's reader wants to know besides (docs/adding-a-corpus.md)."
    )

    @model_validator(mode="after")
    def _one_rule(self) -> Annotation:
        if self.utterance_tier is not None and self.utterance_gap_s is not None:
            raise ValueError("utterance_tier or utterance_gap_s, not both")
        if (self.sign_tier is None) == (self.sign_tiers is None):
            raise ValueError("sign_tier or sign_tiers, one of them")
        return self

    @model_validator(mode="after")
    def _known_options(self) -> Annotation:
        model = OPTIONS[self.format]
        try:
            model.model_validate(self.options)
        except ValidationError as problems:
            first = problems.errors()[0]
            name = ".".join(str(part) for part in first["loc"])
            if first["type"] == "extra_forbidden":
                known = ", ".join(model.model_fields)
                raise ValueError(f"no option {name!r}; {self.format} has {known}") from None
            message = first["msg"].removeprefix("Input ")
            raise ValueError(f"option {name}: {message}") from None
        return self
