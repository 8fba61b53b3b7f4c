"""`signkin audit`: a paper's folder, one check, the list of checks, claims from a file.

    signkin audit papers/naert2017          the paper's page, with CSV and JSON beside it
    signkin audit check grim --mean 5.19 --n 28 --grain 1
    signkin audit list                      all checks with arguments and an example each
    signkin audit init FILE                 claims.yaml from a text or a table

The exit status is 1 where a number contradicts another, or the input cannot be used.
"""

from __future__ import annotations

import argparse
import inspect
import json
import sys
import textwrap
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from signkin.audit import checks as _registered  # noqa: F401 (importing them registers them)
from signkin.audit.findings import INCONSISTENT, Finding, summary
from signkin.audit.init import init
from signkin.audit.paper import Check, Claim, Paper
from signkin.audit.registry import ABOUT, PUBLISHED, OnPrint, run
from signkin.errors import SignkinError, listed

AuditPapers = Callable[[argparse.Namespace], int]
FIELDS = ("printed", "recomputed", "interval", "settings", "hand", "nearest", "severity")
WORDS = {"hand": "by hand", "nearest": "would be consistent", "interval": "rounding allows"}


def main(arguments: Sequence[str], audit_papers: AuditPapers) -> int:
    """Run a command; audit_papers does the papers, and writes their pages."""
    first = arguments[0] if arguments else ""
    try:
        if first == "list":
            return list_checks(arguments[1:])
        if first == "check":
            return one_check(arguments[1:])
        if first == "init":
            return init(arguments[1:])
        return audit_papers(_papers(arguments))
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1


def _papers(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="signkin audit", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("papers", nargs="+", type=Path,
                        help="folders with claims.yaml, or a folder of such")  # fmt: skip
    parser.add_argument("--to", type=Path, help="the folder of the page, CSV and JSON; "
                        "by default audit-PAPER here")  # fmt: skip
    parser.add_argument("--out", type=Path, help="write the verdicts to this CSV file, too")
    parser.add_argument("--checks", type=Path, help="write every check's findings to this one")
    parser.add_argument("--results", type=Path, help="test on the corpora of this folder, too")
    return parser.parse_args(list(arguments))


def list_checks(names: Sequence[str]) -> int:
    """Print all checks on print, or those named, with their arguments and an example each."""
    if {"-h", "--help"} & set(names):
        print("signkin audit list [NAME ...]: checks with arguments and an example each\n\n"
              "example:\n  signkin audit list grim p_value")  # fmt: skip
        return 0
    unknown = [name for name in names if name not in PUBLISHED]
    if unknown:
        raise SignkinError(
            f"there is no check {listed(unknown)}", expected=listed(sorted(PUBLISHED), 60)
        )
    subjects: dict[str, list[str]] = {}
    for name in sorted(names or PUBLISHED):
        subjects.setdefault(ABOUT[name].subject, []).append(name)
    for subject, of in subjects.items():
        print(f"{subject}\n{'=' * len(subject)}")
        for name in of:
            print("\n".join(_told(name)))
    return 0


def _told(name: str) -> Iterator[str]:
    about, function = ABOUT[name], PUBLISHED[name]
    yield f"\n{name}: {', '.join(arguments_of(name))}"
    yield textwrap.indent(inspect.cleandoc(function.__doc__ or ""), "    ")
    yield f"    Example ({about.outcome}):"
    if about.table:
        table = about.example["table"]
        yield from (f"        {table}: {line}" for line in about.table.splitlines())
    yield f"        {as_yaml(name)}"
    yield f"        {as_command(name)}"


def arguments_of(name: str) -> list[str]:
    """Return a check's arguments, with their defaults in brackets."""
    parameters = list(inspect.signature(PUBLISHED[name]).parameters.values())[1:]
    return [
        p.name if p.default is inspect.Parameter.empty else f"{p.name} ({p.default!r})"
        for p in parameters
    ]


def as_yaml(name: str) -> str:
    """Return the example of a check as it stands in claims.yaml."""
    parts = {"check": name, **ABOUT[name].example}
    return "{" + ", ".join(f"{k}: {json.dumps(v)}" for k, v in parts.items()) + "}"


def as_command(name: str) -> str:
    """Return the example of a check as a command; `;` parts lists of lists."""
    words = [f"signkin audit check {name}"]
    for key, value in ABOUT[name].example.items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        if isinstance(value, list):
            nested = [",".join(v) if isinstance(v, list) else v for v in value]
            text = (";" if any(isinstance(v, list) for v in value) else ",").join(nested)
        words.append(f"--{key} '{text}'" if set(text) & set(" <>*()&|;") else f"--{key} {text}")
    return " ".join(words)


def one_check(arguments: Sequence[str]) -> int:
    """Run one check on numbers of the command line, or on a table (`--table FILE`)."""
    if not arguments or arguments[0] in ("-h", "--help"):
        print("signkin audit check NAME --argument value ...; signkin audit list tells them all")
        return 0 if arguments else 1
    name, given, as_json = arguments[0], _given(arguments[1:]), False
    if "json" in given:
        as_json = given.pop("json") != "false"
    folder = Path()
    if "table" in given:
        path = Path(given["table"])
        folder, given["table"] = path.parent, path.name
    findings = findings_of(name, given, folder)
    if as_json:
        names = ("item", "verdict", "why", *FIELDS)
        print(json.dumps([{k: getattr(f, k) for k in names} for f in findings], indent=2))
    else:
        for finding in findings:
            print("\n".join(told_finding(finding)))
    for finding in findings:
        if finding.fault:
            print(f"signkin: {finding.why}", file=sys.stderr)
    return int(summary(findings) == INCONSISTENT or any(f.fault for f in findings))


def _given(words: Sequence[str]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    left = list(words)
    while left:
        word = left.pop(0)
        if not word.startswith("--") or len(word) < 3:
            raise SignkinError(f"the argument {word!r}", expected="--name value")
        key, equals, value = word[2:].partition("=")
        if not equals:
            if key == "json" and (not left or left[0].startswith("--")):
                value = "true"
            elif not left:
                raise SignkinError(f"--{key} stands without a value", expected="--name value")
            else:
                value = left.pop(0)
        out[key.replace("-", "_")] = value
    return out


def findings_of(name: str, given: dict[str, Any], folder: Path) -> list[Finding]:
    """Return what a check says of arguments given as a claim gives them; tables lie in folder."""
    check = Check(name, given, "", True, "", False, False, 1)
    claim = Claim("check", "", "", {}, (check,), "", (), "", "", 1)
    paper = Paper(folder, "", "", (claim,), ())
    try:
        return run(check, OnPrint(paper, claim))
    except SignkinError as error:
        here = error.file == paper.file  # no claims.yaml is meant: the command line is
        raise SignkinError(
            error.found.replace(" of claim check", "").replace("claim check names", "there is"),
            file=None if here else error.file, place=None if here else error.place,
            expected=error.expected, todo=error.todo or f"See `signkin audit list {name}`."
            if name in PUBLISHED else error.todo,
        ) from None  # fmt: skip


def told_finding(finding: Finding) -> Iterator[str]:
    """Yield the lines of a finding for a terminal."""
    head = f"{finding.item}: {finding.verdict}" if finding.item else finding.verdict
    yield textwrap.fill(f"{head}: {finding.why}", 100, subsequent_indent="    ")
    for name in FIELDS:
        if value := getattr(finding, name):
            yield textwrap.fill(f"    {WORDS.get(name, name)}: {value}", 100,
                                subsequent_indent="        ")  # fmt: skip
