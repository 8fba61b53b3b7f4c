"""Print the checks as Markdown, for docs/claims.md."""

from __future__ import annotations

import inspect
from collections.abc import Mapping

from signkin.audit.ledger import CORPUS, PUBLISHED
from signkin.audit.registry import CheckFunction

PARTS = (("on printed numbers", PUBLISHED), ("on a corpus", CORPUS))


def document() -> str:
    """Return every check with its arguments and what it says."""
    return "\n".join(line for title, checks in PARTS for line in _part(title, checks)) + "\n"


def _part(title: str, checks: Mapping[str, CheckFunction]) -> list[str]:
    lines = [f"## Checks {title}", ""]
    for name, function in sorted(checks.items()):
        parameters = list(inspect.signature(function).parameters.values())[1:]
        arguments = [
            f"`{p.name}`" + ("" if p.default is inspect.Parameter.empty else f" ({p.default!r})")
            for p in parameters
        ]
        lines += [f"**{name}**: {', '.join(arguments)}", ""]
        lines += [inspect.cleandoc(function.__doc__ or ""), ""]
    return lines


if __name__ == "__main__":
    print(document(), end="")
