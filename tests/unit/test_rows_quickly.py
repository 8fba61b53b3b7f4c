"""The quick check of rows says yes only where the schema does."""

from __future__ import annotations

import itertools

import jsonschema
import pytest

from signkin import corpus

GOOD = {
    "recordings": {"recording": "r-1", "signer": "s", "motion": "m.bvh", "from_s": "1.5"},
    "signs": {"gloss": "A", "hands": "1", "symmetric": ""},
}
ODD = ["", "x y", "-1", "1.", "0", "exclude", "9" * 20, "é"]


@pytest.mark.parametrize("schema", GOOD)
def test_it_agrees_with_the_schema(schema):
    validator = corpus._validator(schema)
    known = {"type", "pattern", "minLength", "enum", "description"}
    rules = validator.schema["properties"]
    assert all(set(rule) <= known for rule in rules.values()), "a rule that _holds does not know"
    assert corpus._holds(GOOD[schema], schema)
    cells = itertools.product([*rules, "unknown"], ODD)
    rows = [{**GOOD[schema], name: value} for name, value in cells]
    rows += [{k: v for k, v in GOOD[schema].items() if k != gone} for gone in GOOD[schema]]
    for row in rows:
        assert corpus._holds(row, schema) == validator.is_valid(row), row
    assert isinstance(validator, jsonschema.Draft202012Validator)
