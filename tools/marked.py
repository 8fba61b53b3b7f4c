"""Marked places of a Markdown file, which a program fills: begin:NAME to end:NAME, in comments.

What stands between the marks belongs to the program, all else to whoever writes the page.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path


class MarkError(ValueError):
    """A marked place that is not there, not closed, or there twice."""


def _place(name: str) -> re.Pattern[str]:
    mark = re.escape(name)
    return re.compile(
        rf"(^<!-- begin:{mark} -->\n)(.*?)(^<!-- end:{mark} -->$)", re.DOTALL | re.MULTILINE
    )


def names(text: str) -> list[str]:
    """Return the names of the places in a text; an open, doubled or nested one is an error."""
    found: list[str] = []
    inside = None
    for kind, name in re.findall(r"^<!-- (begin|end):(\S+) -->$", text, re.MULTILINE):
        if (kind == "begin") != (inside is None) or (kind == "end" and name != inside):
            raise MarkError(f"{kind}:{name} stands inside {inside}")
        inside = name if kind == "begin" else None
        if kind == "begin":
            found.append(name)
    if inside is not None:
        raise MarkError(f"begin:{inside} has no end")
    if len(set(found)) != len(found):
        raise MarkError(f"a place is there twice: {', '.join(sorted(found))}")
    return found


def content(text: str, name: str) -> str:
    """Return what stands in a place."""
    found = _place(name).search(text)
    if found is None:
        raise MarkError(f"no place <!-- begin:{name} --> ... <!-- end:{name} -->")
    return found[2]


def filled(text: str, contents: Mapping[str, str]) -> str:
    """Return the text with places filled anew."""
    for name, new in contents.items():
        content(text, name)  # the error, where there is no such place
        inside = new.strip("\n") + "\n"
        text = _place(name).sub(lambda m, inside=inside: m[1] + inside + m[3], text)
    return text


def fill(path: Path, contents: Mapping[str, str]) -> bool:
    """Fill places of a file; returns whether anything changed."""
    old = path.read_text(encoding="utf-8")
    new = filled(old, contents)
    if new != old:
        path.write_text(new, encoding="utf-8")
    return new != old
