"""config.yaml, its JSON Schema and docs/configuration.md, written from the settings' models."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import yaml
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from signkin.settings.corpus import CorpusDescription
from signkin.settings.sections import Settings

WIDTH = 100
HEAD = """\
# The scientific choices of a run, made from the models in src/signkin/settings (change those, then
# `make settings`). A key that is left out has its default. Each key's unit and the place in the
# paper that it stands for are in brackets; what the papers leave open is told in
# docs/interpretations.md. Cores, memory and folders of a cluster belong into a profile, not here.
"""
PAGE = """\
# Configuration

Every key of `config.yaml`, from the models in `src/signkin/settings` (this page is made by
`make settings`, and a test compares it). A key that is left out has the default. Checked before any
job starts: unknown keys (the nearest right one is named), types, ranges, and keys that contradict
one another (an order not below the fewest bins, a cut-off not below half the lowest sampling rate,
bounds in the wrong order). What the papers leave open, and how far results move with it:
[interpretations](interpretations.md).
"""


def config_text(settings: Settings | None = None) -> str:
    """Return settings as config.yaml, with the models' texts as comments."""
    return HEAD + "\n" + "".join(_yaml(settings or Settings(), ""))


def _yaml(section: BaseModel, indent: str) -> Iterator[str]:
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if isinstance(value, BaseModel):
            yield ("\n" if not indent else "") + _comment(_doc(value), indent)
            yield f"{indent}{name}:\n"
            yield from _yaml(value, indent + "  ")
            continue
        yield _comment(told(field), indent)
        if isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            yield f"{indent}{name}:\n"
            for item in value:
                yield f"{indent}  - {yaml_value(plain(item))}\n"
        else:
            yield f"{indent}{name}: {yaml_value(plain(value))}\n"


def _comment(text: str, indent: str) -> str:
    lines = textwrap.wrap(text, WIDTH - len(indent) - 2, break_long_words=False)
    return "".join(f"{indent}# {line}\n" for line in lines)


def _doc(section: BaseModel) -> str:
    return " ".join((type(section).__doc__ or "").split())


def told(field: FieldInfo) -> str:
    """Return what a key is, with its unit and its place in the paper in brackets."""
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    brackets = "; ".join(str(extra[k]) for k in ("unit", "paper") if k in extra)
    return (field.description or "") + (f" [{brackets}]" if brackets else "")


def plain(value: Any) -> Any:
    """Return a value of a model as what YAML knows."""
    if isinstance(value, BaseModel):
        return {name: plain(inner) for name, inner in value}
    return [plain(inner) for inner in value] if isinstance(value, tuple) else value


def yaml_value(value: Any) -> str:
    """Return a value on one line of YAML."""
    dumped = yaml.safe_dump(
        value, default_flow_style=True, width=10_000, sort_keys=False, allow_unicode=True
    )
    return dumped.removesuffix("\n").removesuffix("\n...")


def schema_text() -> str:
    """Return the JSON Schema of config.yaml, as YAML, for editors."""
    return _schema(Settings, "config.yaml")


def corpus_schema_text() -> str:
    """Return the JSON Schema of corpus.yaml, as YAML, for editors."""
    return _schema(CorpusDescription, "corpus.yaml, one corpus")


def _schema(model: type[BaseModel], title: str) -> str:
    content = {
        "$schema": "https://json-schema.org/draft/2020-12/schema", **model.model_json_schema(),
        "title": title,
    }  # fmt: skip
    head = "# Made from the models in src/signkin/settings by `make settings`.\n"
    return head + yaml.safe_dump(content, sort_keys=False, width=WIDTH, allow_unicode=True)


def page_text() -> str:
    """Return docs/configuration.md: a table a section."""
    return PAGE + "".join(_tables(Settings(), ""))


def _tables(section: BaseModel, name: str) -> Iterator[str]:
    rows: list[str] = []
    inner: list[tuple[str, BaseModel]] = []
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        if isinstance(value, BaseModel):
            inner.append((f"{name}.{key}".lstrip("."), value))
            continue
        extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
        cells = (
            f"`{key}`", _default(value), extra.get("unit", ""), allowed(type(section), key),
            field.description or "", extra.get("paper", ""),
        )  # fmt: skip
        rows.append("| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |\n")
    yield f"\n## {f'`{name}`' if name else 'The run'}\n\n{_doc(section)}\n"
    if rows:
        yield "\n| key | default | unit | allowed | what | paper |\n|---|---|---|---|---|---|\n"
        yield from rows
    for deeper, value in inner:
        yield from _tables(value, deeper)


def _default(value: Any) -> str:
    if isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
        return f"{len(value)} of the shipped corpora"
    return f"`{yaml_value(plain(value))}`"


def allowed(model: type[BaseModel], key: str) -> str:
    """Return the values that a key takes, from its JSON Schema."""
    content = model.model_json_schema()
    return _allowed(content["properties"][key], content.get("$defs", {}))


def _allowed(rule: dict[str, Any], defs: dict[str, Any]) -> str:
    if "$ref" in rule:
        return "a list of " + ", ".join(defs[rule["$ref"].rpartition("/")[2]]["properties"])
    if "anyOf" in rule:
        return " or ".join(_allowed(one, defs) for one in rule["anyOf"])
    if "enum" in rule or "const" in rule:
        values = rule.get("enum", [rule.get("const")])
        return ", ".join(f"`{value}`" for value in values)
    if rule.get("type") == "array":
        items = rule.get("items", {})
        inner = _allowed(items, defs)
        return inner if "$ref" in items else f"a list of: {inner}"
    kinds = {"integer": "whole number", "number": "number", "string": "text",
             "boolean": "`true`, `false`", "null": "`null`"}  # fmt: skip
    text = kinds.get(rule.get("type", ""), str(rule.get("type", "")))
    limits = {"minimum": "from", "exclusiveMinimum": "above", "maximum": "to",
              "exclusiveMaximum": "below"}  # fmt: skip
    bounds = [f"{word} {rule[name]:g}" for name, word in limits.items() if name in rule]
    return " ".join([text, *bounds])
