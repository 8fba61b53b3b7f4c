"""What sections of settings are made of: a frozen model, and a key with its unit and source."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field


class Section(BaseModel):
    """A section of settings: frozen, of exact types, without unknown keys.

    `dict(section)` gives its keys as arguments of a function that takes them by name.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, validate_default=True
    )


def key(
    default: Any = ...,
    text: str = "",
    *,
    unit: str | None = None,
    paper: str | None = None,
    **limits: Any,
) -> Any:
    """Return a field: its default, what it is, its unit, and where in which paper it stands.

    limits: pydantic's (ge, gt, le, lt, min_length, ...). Without a default the key is required.
    """
    extra: dict[str, Any] = {
        name: value for name, value in (("unit", unit), ("paper", paper)) if value
    }
    return Field(default, description=text, json_schema_extra=extra or None, **limits)


# A list in YAML is a tuple here, so that a section stays as it was read.
def each_once(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Refuse a list that says a value twice."""
    for value in values:
        if values.count(value) > 1:
            raise ValueError(f"{value!r} stands there more than once")
    return values


def address(text: str) -> str:
    """Refuse what is no address of a storage service."""
    scheme, separator, place = text.partition("://")
    if not (separator and scheme.isalnum() and place.strip("/")):
        raise ValueError(f"{text!r} is no address, s3://bucket/folder")
    return text


Share = Annotated[float, Field(ge=0, le=1)]
Positive = Annotated[float, Field(gt=0)]
Hertz = Annotated[float, Field(gt=0, le=100_000)]
Order = Annotated[int, Field(ge=0, le=9)]
