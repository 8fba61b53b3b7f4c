"""A mapping as settings: unknown keys, wrong types, values out of range, contradictions."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from signkin.errors import SignkinError, listed
from signkin.settings.sections import Prior, Settings

Model = TypeVar("Model", bound=BaseModel)
HINT = "docs/configuration.md tells each key's unit and meaning."

# What pydantic says of these is about Python, not about a YAML file.
RULES = {
    "too_short": "a list of one value or more",
    "tuple_type": "a list",
    "model_type": "keys of its own below it",
    "invalid_key": "keys that are words",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "string_type": "a text",
    "string_pattern_mismatch": "letters, digits, dots, hyphens and underscores",
}

# Keys that had another name, and where they are now.
RENAMED = {
    "refinement.window_s": "refinement.search_window_s",
    "binning.window_s": "binning.hit_window_s",
    "binning.sensitivity": "open_choices.endres2013",
    "multiverse": "open_choices.naert2017",
    "open_choices.naert2017.window_s": "open_choices.naert2017.search_window_s",
}


def load_settings(config: Mapping[str, Any], file: str | Path = "config.yaml") -> Settings:
    """Return the settings of a run; what is not given has its default.

    config: the content of config.yaml. Raises SignkinError at the first fault: an unknown key
    (the nearest right one is named), a wrong type, a value out of range, a contradiction.
    """
    settings = checked(Settings, config, file, renamed=RENAMED, hint=HINT)
    for place, found, expected in contradictions(settings):
        raise SignkinError(found, file=file, place=f"key {place}", expected=expected, todo=HINT)
    return settings


def checked(
    model: type[Model],
    content: Mapping[str, Any],
    file: str | Path,
    *,
    renamed: Mapping[str, str] | None = None,
    hint: str | None = None,
) -> Model:
    """Return a mapping as a model; the first fault is a SignkinError that names its key."""
    if not isinstance(content, Mapping):
        raise SignkinError("no keys", file=file, expected="a mapping of keys to values", todo=hint)
    try:
        return model.model_validate(dict(content))
    except ValidationError as problems:
        raise _told(model, problems.errors(), file, renamed or {}, hint) from None


def _told(
    model: type[BaseModel],
    errors: list[ErrorDetails],
    file: str | Path,
    renamed: Mapping[str, str],
    hint: str | None,
) -> SignkinError:
    """Return the first error as a sentence: unknown keys first, they explain missing ones."""
    first = sorted(errors, key=lambda e: e["type"] != "extra_forbidden")[0]
    path = [part for part in first["loc"] if not _is_branch(part)]
    place = ".".join(str(part) for part in path)
    found = short(first["input"])
    if first["type"] == "extra_forbidden":
        return SignkinError(
            f"there is no key {place}", file=file, place=f"key {place}",
            expected=_instead(model, path, renamed), todo=hint,
        )  # fmt: skip
    if first["type"] == "missing":
        return SignkinError(
            f"the key {place} is missing", file=file, place=f"key {place}",
            expected=described(model, path), todo=hint,
        )  # fmt: skip
    wanted = described(model, path)
    rule = RULES.get(first["type"]) or first["msg"]
    rule = rule.removeprefix("Input should be ").removeprefix("Value error, ")
    expected = f"{rule} ({wanted})" if wanted else rule
    return SignkinError(found, file=file, place=f"key {place}", expected=expected, todo=hint)


def _is_branch(part: int | str) -> bool:
    """Tell pydantic's names of the branches of a union from keys."""
    return isinstance(part, str) and (
        part.startswith(("literal[", "function-", "tuple[", "list[", "constrained-", "dict["))
        or part in ("float", "int", "str", "none", "bool")
    )


def short(value: object, most: int = 60) -> str:
    """Return a value as it is quoted in a message: at most a line of it."""
    text = repr(value)
    return text if len(text) <= most else f"{text[:most]}..."


def section_at(model: type[BaseModel], path: Sequence[int | str]) -> type[BaseModel] | None:
    """Return the model that holds the last key of a path, where there is one."""
    here: type[BaseModel] | None = model
    for part in path[:-1]:
        if here is None:
            return None
        if isinstance(part, int):
            continue
        field = here.model_fields.get(part)
        here = None if field is None else _inner(field.annotation)
    return here


def _inner(annotation: Any) -> type[BaseModel] | None:
    """Return the model within an annotation such as `tuple[Model, ...]` or `Model | None`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for part in getattr(annotation, "__args__", ()):
        found = _inner(part)
        if found is not None:
            return found
    return None


def described(model: type[BaseModel], path: Sequence[int | str]) -> str:
    """Return what a key is, with its unit; empty where it is not described."""
    named = [part for part in path if isinstance(part, str)]
    here = section_at(model, named)
    field = None if here is None or not named else here.model_fields.get(named[-1])
    if field is None or not field.description:
        return ""
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    unit = f", in {extra['unit']}" if "unit" in extra else ""
    return field.description.rstrip(".") + unit


def _instead(model: type[BaseModel], path: list[int | str], renamed: Mapping[str, str]) -> str:
    """Return the key that was meant: its new name, the nearest here, or the same elsewhere."""
    place = ".".join(str(part) for part in path)
    if place in renamed:
        return f"{renamed[place]}, its name now"
    here = section_at(model, path)
    names = [] if here is None else list(here.model_fields)
    wrong = str(path[-1])
    near = difflib.get_close_matches(wrong, names, 1, 0.6)
    if near:
        return ".".join([*(str(p) for p in path[:-1]), near[0]])
    everywhere = dict(all_keys(model))
    ends = [key for key in everywhere if key.rpartition(".")[2] == wrong]
    if not ends:
        near = difflib.get_close_matches(place, list(everywhere), 1, 0.6)
        ends = near
    return f"{ends[0]}, perhaps" if ends else f"one of {listed(names, 20)}"


def all_keys(model: type[BaseModel], before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every key of a model with dots between sections, and its field."""
    for name, field in model.model_fields.items():
        yield f"{before}{name}", field
        inner = field.annotation
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            yield from all_keys(inner, f"{before}{name}.")


def contradictions(settings: Settings) -> Iterator[tuple[str, str, str]]:
    """Yield keys that contradict one another: the key, what was found, what was expected."""
    binning, choices = settings.binning, settings.open_choices.endres2013
    for place, orders, bins in (
        ("binning.orders", binning.orders, binning.bins),
        ("binning.fitted_orders", binning.fitted_orders, binning.bins),
        ("open_choices.endres2013.orders", choices.orders, min(choices.bins)),
    ):
        if max(orders) >= bins:
            yield place, f"order {max(orders)} with {bins} bins", f"orders below {bins}"
    for place, prior in (
        ("binning.prior", binning.prior), ("open_choices.endres2013.beside", choices.beside),
    ):  # fmt: skip
        yield from _prior_without_unit(place, prior)
    own = binning.continuous
    if own.longest_segment_s < (own.order + 1) * own.bin_s:
        yield (
            "binning.continuous.longest_segment_s",
            f"{own.longest_segment_s:g} s for order {own.order} and bins of {own.bin_s:g} s",
            f"at least {(own.order + 1) * own.bin_s:g} s, a bin for each coefficient",
        )
    law = settings.powerlaw
    if law.least_exponent >= law.most_exponent:
        yield (
            "powerlaw.least_exponent",
            f"{law.least_exponent:g} with most_exponent {law.most_exponent:g}",
            f"below {law.most_exponent:g}",
        )
    # Neighbours alternate at best between the two ends of the range.
    elif law.least_exponent_step > law.most_exponent - law.least_exponent:
        yield (
            "powerlaw.least_exponent_step",
            f"{law.least_exponent_step:g} in a range of {law.least_exponent:g} to "
            f"{law.most_exponent:g}",
            f"at most {law.most_exponent - law.least_exponent:g}",
        )
    if settings.durations.lowest_s >= settings.durations.highest_s:
        yield (
            "durations.lowest_s",
            f"{settings.durations.lowest_s:g} s with highest_s {settings.durations.highest_s:g} s",
            f"below {settings.durations.highest_s:g} s",
        )
    made: set[tuple[str, str]] = set()
    for wanted in settings.synthesis.utterances:
        if (wanted.corpus, wanted.name) in made:
            yield (
                "synthesis.utterances",
                f"two utterances of {wanted.corpus} are named {wanted.name}",
                "each name once a corpus",
            )
        made.add((wanted.corpus, wanted.name))


def _prior_without_unit(place: str, prior: Prior) -> Iterator[tuple[str, str, str]]:
    literal = prior.scale == "literal"
    if literal and prior.noise != "data":
        yield (
            f"{place}.noise", f"{prior.noise} with scale literal",
            "data: read literally, V is the data's variances",
        )  # fmt: skip
    if literal and prior.length_unit is None:
        yield (
            f"{place}.length_unit", "no unit of length with scale literal",
            "mm, cm or m: the data's variances as precisions depend on it",
        )  # fmt: skip
    if not literal and prior.length_unit is not None:
        yield (
            f"{place}.length_unit", f"{prior.length_unit} with scale {prior.scale}",
            "null: nothing depends on the unit of length, or scale literal",
        )  # fmt: skip


def check_shown_orders(settings: Settings, file: str | Path) -> None:
    """Refuse a run without order 3, whose fits Fig. 3 of Endres et al. shows."""
    binning = settings.binning
    for place, orders in (
        ("binning.orders", binning.orders), ("binning.fitted_orders", binning.fitted_orders),
    ):  # fmt: skip
        if 3 not in orders:
            raise SignkinError(
                f"orders {', '.join(map(str, orders))}", file=file, place=f"key {place}",
                expected="order 3 among them, which Fig. 3 shows", todo=HINT,
            )  # fmt: skip


def cutoffs(settings: Settings) -> Iterator[tuple[str, float]]:
    """Yield the keys of all low-pass cut-offs and their values, Hz.

    Those of open_choices are not among them: a combination that a corpus does not allow is left out
    there and counted.
    """
    yield "kinematics.lowpass.cutoff_hz", settings.kinematics.lowpass.cutoff_hz
    yield "binning.lowpass.cutoff_hz", settings.binning.lowpass.cutoff_hz


def check_rate(settings: Settings, rate_hz: float, whose: str, file: str | Path) -> None:
    """Refuse a cut-off that is not below half a sampling rate (Hz); whose: a corpus."""
    for place, cutoff_hz in cutoffs(settings):
        if cutoff_hz >= rate_hz / 2:
            raise SignkinError(
                f"a cut-off of {cutoff_hz:g} Hz, and {whose} has {rate_hz:g} Hz",
                file=file,
                place=f"key {place}",
                expected=f"below {rate_hz / 2:g} Hz, half the lowest rate",
                todo="Lower the cut-off, or leave the corpus out (`corpora`).",
            )
