"""Methods: every choice of a run with its unit and source, from the settings' models."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pandas as pd
from pydantic import BaseModel

import signkin
from signkin.pages.sources import Sources
from signkin.report.page import Page, Section, TableView
from signkin.settings import Settings
from signkin.settings.text import allowed, plain, yaml_value

METHODS = "Methods"


def methods_page(sources: Sources, site: list[tuple[str, Path]]) -> Page:
    """Return the page: a section of config.yaml a table, what differs from the default marked."""
    return Page(
        title="Methods: every choice of this run",
        lead=(
            "What the papers leave open, as this run decided it. Each key stands in config.yaml, "
            "with its unit and the place of the paper that it stands for.",
        ),
        sections=list(_sections(sources.settings, Settings(), "")),
        version=signkin.__version__,
        site=site,
        here=METHODS,
        docs=sources.docs,
    )


def _sections(section: BaseModel, default: BaseModel, name: str) -> Iterator[Section]:
    rows: list[dict[str, object]] = []
    inner = []
    for key, field in type(section).model_fields.items():
        value, usual = getattr(section, key), getattr(default, key)
        if isinstance(value, BaseModel):
            inner.append((value, usual, f"{name}.{key}".lstrip(".")))
            continue
        extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
        rows.append(
            {
                "key": f"{name}.{key}".lstrip("."),
                "value": yaml_value(plain(value)),
                "unit": extra.get("unit", ""),
                "what": (field.description or "").replace("`", ""),
                "paper": extra.get("paper", ""),
                "default": "" if value == usual else yaml_value(plain(usual)),
                "allowed": allowed(type(section), key).replace("`", ""),
            }
        )
    if rows:
        yield _section(name, " ".join((type(section).__doc__ or "").replace("`", "").split()), rows)
    for value, usual, deeper in inner:
        yield from _sections(value, usual, deeper)


def _section(name: str, about: str, rows: list[dict[str, object]]) -> Section:
    columns = {
        "key": ("key", ""), "value": ("value", ""), "unit": ("unit", ""), "what": ("what", ""),
        "paper": ("place in the paper", ""), "allowed": ("allowed", ""),
    }  # fmt: skip
    if any(row["default"] for row in rows):
        columns["default"] = ("default, where another", "")
    view = TableView(
        label="", title=name or "The run", caption=about, frame=pd.DataFrame(rows),
        columns=columns, most=60,
    )  # fmt: skip
    return Section(name.replace(".", "-") or "run", name or "The run", exhibits=(view,))
