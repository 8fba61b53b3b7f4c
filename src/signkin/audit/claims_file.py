"""Reading claims.yaml: text that is not UTF-8, deep or doubled is told by its line.

A fault inside one claim leaves the others as they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import yaml

from signkin.errors import SignkinError
from signkin.text_file import text_of
from signkin.yaml_file import composed, constructed

SCHEMA = files("signkin") / "schemas" / "claims.schema.yaml"
GUIDE = "See docs/claims.md."
MOST_BYTES, MOST_NODES, MOST_DEEP = 5_000_000, 200_000, 40
Path_ = tuple[Any, ...]


@dataclass
class ClaimsFile:
    """The content of claims.yaml, the line of every key, and what cannot be used of it.

    content: without the claims that have a fault; `numbers` are the places in the file of those
    that are left.
    """

    content: dict[str, Any]
    lines: dict[Path_, int]
    numbers: list[int]
    faults: list[SignkinError] = field(default_factory=list)


def read_claims(path: Path) -> ClaimsFile:
    """Read and check claims.yaml; what is wrong with the file as a whole is an error."""
    text = text_of(path, MOST_BYTES)
    try:
        node = composed(text)
        if node is None:
            raise SignkinError("it is empty", file=path, expected="paper and claims",
                               todo=GUIDE)  # fmt: skip
        lines: dict[Path_, int] = {}
        doubled: list[tuple[Path_, str, int]] = []
        for at, line, again in _walk(node, (), [0], path):
            if again:
                doubled.append((at, str(at[-1]), line))
            else:
                lines[at] = line
        content = constructed(node)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = None if mark is None else f"line {mark.line + 1}"
        problem = getattr(error, "problem", None) or "it is not YAML"
        raise SignkinError(str(problem), file=path, place=place) from None
    except RecursionError:
        raise SignkinError(
            "it is nested too deep to be read", file=path, expected=f"at most {MOST_DEEP} levels"
        ) from None
    except ValueError as error:  # a date such as 2024-13-45
        raise SignkinError(str(error), file=path, expected="such text in quotes") from None
    out = ClaimsFile({}, lines, [])
    bad = _doubled(doubled, path, out)
    _check(content, path, lines, out, bad)
    return out


def _doubled(doubled: list[tuple[Path_, str, int]], path: Path, out: ClaimsFile) -> set[int]:
    """Tell the keys that stand twice; returns the places of the claims that have one."""
    bad = set()
    for at, key, line in doubled:
        error = SignkinError(
            f"the key {key!r} stands there twice", file=path, place=f"line {line}",
            expected="each once",
        )  # fmt: skip
        if len(at) > 2 and at[0] == "claims":
            bad.add(at[1])
            out.faults.append(error)
        else:
            raise error
    return bad


def _walk(node: Any, at: Path_, seen: list[int], path: Path) -> Iterator[tuple[Path_, int, bool]]:
    """Yield (path, line, whether the key stands there for the second time)."""
    line = node.start_mark.line + 1
    seen[0] += 1
    if seen[0] > MOST_NODES or len(at) > MOST_DEEP:
        what = f"more than {MOST_DEEP} levels" if len(at) > MOST_DEEP else "too many parts"
        raise SignkinError(f"it has {what}", file=path, place=f"line {line}",
                           expected="claims as in docs/claims.md")  # fmt: skip
    yield at, line, False
    if isinstance(node, yaml.MappingNode):
        keys = set()
        for key, value in node.value:
            again = str(key.value) in keys
            keys.add(str(key.value))
            if not again:
                yield from _walk(value, (*at, key.value), seen, path)
            yield (*at, key.value), key.start_mark.line + 1, again
    elif isinstance(node, yaml.SequenceNode):
        for i, value in enumerate(node.value):
            yield from _walk(value, (*at, i), seen, path)


@cache
def _validator(part: str = "") -> jsonschema.Draft202012Validator:
    content = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))
    if part:
        content = {"$schema": content["$schema"], "$ref": f"#/$defs/{part}",
                   "$defs": content["$defs"]}  # fmt: skip
    return jsonschema.Draft202012Validator(content)


def _check(
    content: Any, path: Path, lines: Mapping[Path_, int], out: ClaimsFile, bad: set[int]
) -> None:
    claims = content.get("claims") if isinstance(content, dict) else None
    whole = content
    if isinstance(claims, list) and claims:
        # The frame alone first; its claims follow one by one.
        whole = {**content, "claims": [_NO_CLAIM]}
    if (error := _fault(_validator(), whole, path, lines, ())) is not None:
        raise error
    seen: dict[str, int] = {}
    kept = []
    for i, claim in enumerate(claims or []):
        if i in bad:
            continue
        error = _fault(_validator("claim"), claim, path, lines, ("claims", i))
        if error is None and claim.get("corpora", {}).get("checks") and "study" not in content:
            error = SignkinError(
                "it has checks on corpora, and the paper no study", file=path,
                place=f"line {lines['claims', i, 'corpora']}",
                expected="study: the folder of the results that they read",
            )  # fmt: skip
        if error is None and claim["id"] in seen:
            error = SignkinError(
                f"the claim {claim['id']} stands in line {seen[claim['id']]} already",
                file=path, place=f"line {lines['claims', i]}", expected="each once",
            )  # fmt: skip
        if error is not None:
            out.faults.append(error)
            continue
        seen[claim["id"]] = lines["claims", i]
        kept.append(claim)
        out.numbers.append(i)
    out.content = {**content, "claims": kept}
    if not kept:
        raise out.faults[0]


_NO_CLAIM = {
    "id": "X", "location": "x", "claim": "x", "published": {"missing": "x"},
}  # fmt: skip


def _fault(
    validator: jsonschema.Draft202012Validator, content: Any, path: Path,
    lines: Mapping[Path_, int], start: Path_,
) -> SignkinError | None:  # fmt: skip
    error = jsonschema.exceptions.best_match(validator.iter_errors(content))
    if error is None:
        return None
    at = (*start, *error.absolute_path)
    while at not in lines:
        at = at[:-1]
    rule = error.schema if isinstance(error.schema, dict) else {}
    return SignkinError(
        error.message if len(error.message) < 160 else error.message[:157] + "...",
        file=path, place=f"line {lines[at]}", expected=rule.get("description"), todo=GUIDE,
    )  # fmt: skip
