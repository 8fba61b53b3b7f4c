"""YAML files that people write: UTF-8, one mapping, each key once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from signkin.errors import SignkinError

LARGEST = 10_000_000  # characters; the largest that anyone here has written has 30,000
DEEPEST = 50  # levels; PyYAML recurses, and Python ends at about 1,000


def read_yaml(path: Path, guide: str | None = None) -> dict[str, Any]:
    """Return the mapping in a YAML file; guide: what an error tells the user to read.

    Raises SignkinError where there is no such file, where it is not UTF-8, not YAML, holds a key
    twice, is too long or too deep, or holds no mapping.
    """
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise SignkinError("there is no such file", file=path, todo=guide) from None
    except OSError as error:
        raise SignkinError(f"it cannot be read ({error.strerror})", file=path) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SignkinError(
            f"the byte 0x{data[error.start]:02x} is not UTF-8",
            file=path,
            place=f"line {data[: error.start].count(10) + 1}",
            expected="UTF-8",
            todo="Save the file as UTF-8.",
        ) from None
    content = parse_yaml(text, path)
    if not isinstance(content, dict):
        raise SignkinError("no keys", file=path, expected="a mapping of keys to values", todo=guide)
    return content


def parse_yaml(text: str, path: Path) -> Any:
    """Return the content of YAML text; path: named in errors."""
    if len(text) > LARGEST:
        raise SignkinError(f"{len(text)} characters", file=path, expected=f"at most {LARGEST}")
    try:
        _check_depth(text, path)
        return yaml.load(text, Loader=_OnceLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = None if mark is None else f"line {mark.line + 1}"
        problem = getattr(error, "problem", None) or "not YAML"
        raise SignkinError(str(problem), file=path, place=place, expected="YAML") from None
    except (ValueError, OverflowError) as error:  # a date with a 13th month, an int of 5,000 digits
        raise SignkinError(f"a value that is none ({error})", file=path, expected="YAML") from None


def composed(text: str) -> yaml.Node | None:
    """Return the nodes of YAML text, with their lines: by libyaml, ten times as fast, if it can.

    What it refuses PyYAML's own parser reads again, or refuses in its own words.
    """
    try:
        return yaml.compose(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (yaml.YAMLError, RecursionError):
        return yaml.compose(text, Loader=yaml.SafeLoader)


def constructed(node: yaml.Node) -> Any:
    """Return the content of nodes, as `yaml.safe_load` does."""
    return yaml.SafeLoader("").construct_document(node)


def _check_depth(text: str, path: Path) -> None:
    """Refuse nesting that would end in a RecursionError; the parser's events do not recurse."""
    depth = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        if isinstance(event, (yaml.MappingStartEvent, yaml.SequenceStartEvent)):
            depth += 1
        elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
            depth -= 1
        elif isinstance(event, yaml.AliasEvent):
            raise SignkinError(
                f"an alias (*{event.anchor})", file=path,
                place=_line(event), expected="values written out",
            )  # fmt: skip
        if depth > DEEPEST:
            raise SignkinError(
                f"more than {DEEPEST} levels", file=path,
                place=_line(event), expected="a few",
            )  # fmt: skip


def _line(event: yaml.Event) -> str | None:
    mark = event.start_mark
    return None if mark is None else f"line {mark.line + 1}"


class _OnceLoader(yaml.SafeLoader):
    """SafeLoader that refuses a key that stands twice in a mapping."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen: dict[Any, int] = {}
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, (str, int, float, bool, type(None))):
                raise yaml.constructor.ConstructorError(
                    None, None, "a key that is a list or a mapping", key_node.start_mark
                )
            if key in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key!r} stands in line {seen[key]} already",
                    key_node.start_mark,
                )  # fmt: skip
            seen[key] = key_node.start_mark.line + 1
        return super().construct_mapping(node, deep=deep)
