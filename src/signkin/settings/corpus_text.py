"""docs/corpus-reference.md, made from the models of corpus.yaml and the schemas of its tables."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from typing import Any, get_args

import yaml
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from signkin.settings.corpus import CorpusDescription
from signkin.settings.text import allowed, plain, yaml_value

NONE = type(None)
SCHEMAS = files("signkin") / "schemas"
PAGE = """\
# Reference: corpus.yaml, recordings.csv, signs.csv

Every key and column, from the models in `src/signkin/settings` and the schemas (this page is made
by `make settings`, and a test compares it). Checked before anything runs: unknown keys (the nearest
right one is named), types, ranges, names of joints, doubled rows, files that are not there.
How to come to such a description, and what the formats' options mean:
[adding a corpus](adding-a-corpus.md).
"""
TABLES = {
    "recordings": "## recordings.csv\n\nA row a recording.\n",
    "signs": "## signs.csv\n\nA row a gloss. Glosses that are not there are typed from motion "
    "([interpretations](interpretations.md#types-of-signs)).\n",
}


def corpus_page_text() -> str:
    """Return docs/corpus-reference.md: a table a section of corpus.yaml, then the CSV files."""
    return PAGE + "".join(_sections(CorpusDescription, "", set())) + "".join(_tables())


def _sections(model: type[BaseModel], name: str, seen: set[type]) -> Iterator[str]:
    title = f"## corpus.yaml: `{name}`" if name else "## corpus.yaml"
    rows, inner = [], []
    for key, field in model.model_fields.items():
        rows.append(_row(model, key, field))
        inner += [(f"{name}.{key}".lstrip("."), deeper) for deeper in _models(field.annotation)]
    doc = " ".join((model.__doc__ or "").split())
    yield f"\n{title}\n\n{doc}\n\n| key | default | unit | allowed | what |\n"
    yield "|---|---|---|---|---|\n"
    yield from rows
    for deeper_name, deeper in inner:
        if deeper not in seen:
            seen.add(deeper)
            yield from _sections(deeper, deeper_name, seen)


def _row(model: type[BaseModel], key: str, field: FieldInfo) -> str:
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    deeper = _models(field.annotation)
    default = "required" if field.is_required() else ""
    if not field.is_required() and field.default not in (None, "", {}, ()) and not deeper:
        default = f"`{yaml_value(plain(field.default))}`"
    values = allowed(model, key).removesuffix(" or `null`").replace("object", "a mapping")
    if deeper:
        plainly = any(not _models(one) for one in get_args(field.annotation) if one != NONE)
        values = "a value, or the keys below" if plainly else "the keys below"
    what = field.description or " ".join((deeper[0].__doc__ or "").split())
    cells = (f"`{key}`", default, extra.get("unit", ""), values, what)
    return "| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |\n"


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Return the sections that a key may hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    found = [model for one in get_args(annotation) for model in _models(one)]
    return list(dict.fromkeys(found))


def _tables() -> Iterator[str]:
    for name, head in TABLES.items():
        schema = yaml.safe_load((SCHEMAS / f"{name}.schema.yaml").read_text(encoding="utf-8"))
        yield f"\n{head}\n| column | | what |\n|---|---|---|\n"
        for column, rule in schema["properties"].items():
            need = "required" if column in schema["required"] else ""
            yield f"| `{column}` | {need} | {rule['description']} |\n"
