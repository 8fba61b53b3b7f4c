"""The checks by name, and what they are given."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, get_type_hints

import pandas as pd

from signkin.audit.expressions import evaluate
from signkin.audit.findings import Finding
from signkin.audit.paper import Check, Claim, Paper
from signkin.audit.rounding import Interval, allowed, exactly, is_number
from signkin.errors import SignkinError, listed
from signkin.tables import TABLES, read_table

CheckFunction = Callable[..., list[Finding]]
PUBLISHED: dict[str, CheckFunction] = {}
CORPUS: dict[str, CheckFunction] = {}
ABOUT: dict[str, About] = {}


@dataclass(frozen=True)
class About:
    """What a check on print is shown with: its subject, an example, and the example's outcome.

    example: arguments as a claim gives them. table: the printed table that the example reads, as
    CSV. outcome: the verdict.
    """

    subject: str
    example: Mapping[str, Any]
    table: str = ""
    outcome: str = "consistent"


class Missing(Exception):
    """A corpus lacks what a check needs; the text says what."""


@dataclass(frozen=True)
class OnPrint:
    """What a check on printed numbers is given: the paper and the claim."""

    paper: Paper
    claim: Claim

    def text(self, name: object) -> str:
        """Return a printed number: of this claim, of another (`N02.mean`), or digits."""
        found = self.claim.printed.get(str(name), self.all_printed.get(str(name)))
        return str(name) if found is None else found

    @cached_property
    def all_printed(self) -> dict[str, str]:
        """Every printed number of the paper by `claim.name`."""
        return self.paper.printed()

    def values(self, exact: tuple[str, ...] = ()) -> dict[str, Interval]:
        """Return what every printed number allows, by name; `exact` ones as they stand."""
        out = {}
        for name, text in {**self.all_printed, **self.claim.printed}.items():
            if not is_number(text):  # a bound, or `ns`
                continue
            value = Interval(exactly(text), exactly(text)) if name in exact else allowed(text)
            out[name] = value
        return out

    def points(self) -> dict[str, Interval]:
        """Return every printed number as its digits stand, for a calculation by hand."""
        return {
            name: Interval(exactly(text), exactly(text))
            for name, text in {**self.all_printed, **self.claim.printed}.items()
            if is_number(text)
        }

    def source(self, table: str) -> str:
        """Return the file of a printed table."""
        return f"papers/{self.paper.folder.name}/{table}"


@dataclass(frozen=True)
class Evidence:
    """A corpus as the audit knows it: its name, whether simulated, its result tables.

    files: table name (`transitions`) -> file. results: the folder that they lie below.
    """

    name: str
    simulated: bool
    files: Mapping[str, Path] = field(default_factory=dict)
    results: Path = Path("results")


@dataclass(frozen=True)
class OnCorpus:
    """What a check on a corpus is given: the claim, and the corpus's result tables."""

    paper: Paper
    claim: Claim
    evidence: Evidence
    swapped: Mapping[str, str] = field(default_factory=dict)  # table -> one read in its place
    where: str = ""  # the rows of such a table

    def table(self, name: str) -> pd.DataFrame:
        """Return a result table; raises Missing where the corpus has none."""
        if name in self.swapped:
            frame = replace(self, swapped={}).table(self.swapped[name])
            try:
                frame = frame[evaluate(self.where, {str(c): frame[c] for c in frame.columns})]
            except SignkinError as error:
                raise Missing(f"{self.swapped[name]}.csv: {error.found}") from None
            if frame.empty:
                raise Missing(f"{self.swapped[name]}.csv has no row with {self.where}")
            return frame
        path = self.evidence.files.get(name)
        if path is None and not any(_writes(t.path, name) for t in TABLES.values()):
            raise Missing(f"no table {name}.csv, and signkin writes none of this name")
        if path is None:
            raise Missing(f"no table {name}.csv")
        frame = _read(path, name)
        if frame.empty:
            raise Missing(f"{name}.csv has no rows")
        return frame

    def source(self, name: str) -> str:
        """Return the file of a table."""
        path = self.evidence.files.get(self.swapped.get(name, name))
        if path is None:
            return ""
        return f"results/{path.relative_to(self.evidence.results).as_posix()}"

    def number(self, name: object) -> float:
        """Return a printed number of the claim, or a number."""
        text = self.text(name)
        return float(exactly(text))

    def text(self, name: object) -> str:
        """Return a printed number as text."""
        return OnPrint(self.paper, self.claim).text(name)


_READ: dict[tuple[str, int, int], pd.DataFrame] = {}


def _read(path: Path, name: str) -> pd.DataFrame:
    about = path.stat()
    key = (str(path), about.st_mtime_ns, about.st_size)
    if key not in _READ:
        kind = next((t.name for t in TABLES.values() if _writes(t.path, name)), None)
        _READ[key] = read_table(path, kind) if kind else _guessed(path)
    return _READ[key]


def _writes(paths: str, name: str) -> bool:
    return any(Path(p.strip()).name == f"{Path(name).name}.csv" for p in paths.split(","))


def _guessed(path: Path) -> pd.DataFrame:
    """Read a table that signkin does not declare: numbers where all of a column are."""
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    for column in frame:
        texts = frame[column]
        if texts.str.match(r"0\d").any():  # `0010` is a name
            continue
        filled = texts[texts != ""]
        numbers = pd.to_numeric(filled, errors="coerce")
        if numbers.notna().all():  # a column without any content is one of missing numbers
            frame[column] = pd.to_numeric(texts, errors="coerce")  # empty: missing
        elif len(filled) and filled.isin(["True", "False"]).all():
            frame[column] = texts == "True"
    return frame


def on_print(
    subject: str, example: Mapping[str, Any], table: str = "", outcome: str = "consistent"
) -> Callable[[CheckFunction], CheckFunction]:
    """Register a check on printed numbers under its function's name, with an example."""

    def register(function: CheckFunction) -> CheckFunction:
        PUBLISHED[function.__name__] = function
        ABOUT[function.__name__] = About(subject, example, table, outcome)
        return function

    return register


def on_corpus(function: CheckFunction) -> CheckFunction:
    """Register a check on a corpus's tables under its function's name."""
    CORPUS[function.__name__] = function
    return function


def run(check: Check, context: OnPrint | OnCorpus) -> list[Finding]:
    """Run a check; an unknown name or argument is an error at its line of claims.yaml."""
    known = PUBLISHED if isinstance(context, OnPrint) else CORPUS
    place = f"line {check.line}"
    file = context.paper.file
    if check.name not in known:
        raise SignkinError(
            f"claim {context.claim.id} names an unknown check {check.name!r}",
            file=file,
            place=place,
            expected=listed(sorted(known), 30),
        )
    function = known[check.name]
    wanted = dict(list(inspect.signature(function).parameters.items())[1:])
    unknown = [name for name in check.arguments if name not in wanted]
    lacking = [
        name
        for name, p in wanted.items()
        if p.default is inspect.Parameter.empty and name not in check.arguments
    ]
    if unknown or lacking:
        raise SignkinError(
            f"the check {check.name} of claim {context.claim.id} "
            + (f"has no argument {listed(unknown)}" if unknown else f"lacks {listed(lacking)}"),
            file=file,
            place=place,
            expected=listed(wanted, 30),
        )
    arguments: dict[str, Any] = dict(check.arguments)
    try:
        if isinstance(context, OnPrint):
            arguments = typed(function, arguments)
            return function(context, **arguments)
        return function(context, **arguments)
    except Missing as missing:
        if "of this name" in str(missing):
            raise Missing(f"{missing} (papers/{file.parent.name}/{file.name}, {place})") from None
        raise
    except SignkinError as error:
        raise error.at(file=file, place=place) from None
    except (TypeError, ValueError, LookupError, AttributeError, ArithmeticError) as error:
        if isinstance(context, OnCorpus):
            raise
        raise SignkinError(
            f"the arguments of {check.name} of claim {context.claim.id} cannot be used "
            f"({type(error).__name__})",
            file=file, place=place, todo=f"See `signkin audit list {check.name}`.",
        ) from None  # fmt: skip


def typed(function: CheckFunction, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return arguments as the function wants them; each that cannot be is an error by name.

    Text of the command line is taken apart at commas where a list is wanted.
    """
    hints = get_type_hints(function)
    if "alpha" in given:
        level = _word("alpha", str(given["alpha"]))
        if not is_number(level) or not 0 < exactly(level) < 1:
            raise SignkinError(f"alpha is {level[:40]!r}", expected="a number between 0 and 1")
        given = {**given, "alpha": level}
    return {name: _typed(name, value, str(hints[name])) for name, value in given.items()}


def _typed(name: str, value: Any, hint: str) -> Any:
    if hint == "<class 'bool'>":
        told = {"true": True, "yes": True, "false": False, "no": False}
        if isinstance(value, bool) or str(value).lower() in told:
            return value if isinstance(value, bool) else told[str(value).lower()]
        raise SignkinError(f"{name} is {str(value)[:40]!r}", expected="true or false")
    if "Mapping" in hint:
        if isinstance(value, Mapping):
            return value
        raise SignkinError(f"{name} is {str(value)[:40]!r}", expected="names with their values")
    if "Sequence" in hint:
        parts = value.split(",") if isinstance(value, str) else value
        parts = parts if isinstance(parts, list | tuple) else [parts]
        if hint.count("Sequence") == 2:
            parts = value.split(";") if isinstance(value, str) else parts
            return [_typed(name, part, hint.replace("Sequence", "", 1)) for part in parts]
        return [_word(name, part) for part in parts]
    if hint == "<class 'float'>":
        return float(exactly(str(value)))
    if value is None and "None" in hint:
        return None
    return _word(name, value)


def _word(name: str, value: Any) -> str:
    if isinstance(value, float | bool) or not isinstance(value, str | int):
        raise SignkinError(
            f"{name} is {str(value)[:40]!r}, and no text",
            expected="printed digits in quotes, because trailing zeros count",
        )
    return str(value).strip()
