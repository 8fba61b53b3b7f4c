"""What a reader is warned of: each kind of trouble once, with all it was found in."""

from __future__ import annotations

from collections.abc import Iterator

from signkin.errors import listed
from signkin.pages.sources import Sources
from signkin.pages.unavailable import unavailable_lines
from signkin.report.page import Group
from signkin.studies.naert2017.report import unused_glosses
from signkin.unavailable import rows_of

MOST_LINES = 200  # of a group; the tables have all


def groups(sources: Sources, *corpora: str) -> list[Group]:
    """Return the warnings of a run, or of some corpora of it, the gravest first."""
    names = corpora or tuple(sources.corpora)
    out = [] if corpora else list(_missing(sources))
    out += _left_out(sources, names)
    out += _unavailable(sources, names)
    out += _implausible(sources, names)
    out += _glosses(sources, names)
    out += _tags(sources, names)
    out += _decided(sources, names)
    return out


def _group(told: str, lines: list[str], warns: bool = True) -> Iterator[Group]:
    if lines:
        over = len(lines) - MOST_LINES
        more = [f"and {over} more, in the tables of each corpus"] if over > 0 else []
        yield Group(told, lines[:MOST_LINES] + more, warns)


def counted(n: int, one: str, many: str) -> str:
    """Return `1 recording`, `2 recordings`."""
    return f"{n} {one if n == 1 else many}"


def _missing(sources: Sources) -> Iterator[Group]:
    lines = [f"{name} is not in this run: {why}." for name, why in sources.missing.items()]
    n = len(lines)
    told = f"{counted(n, 'corpus is', 'corpora are')} not in this run: {listed(sources.missing)}"
    yield from _group(told, lines)


def _left_out(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    lines, where = [], {}
    for name in names:
        excluded = sources.table(name, "excluded")
        where[name] = len(excluded)
        lines += [
            f"{name}: recording {row.recording} is left out. {row.reason}"
            for row in excluded.itertuples()
        ]
    told = ", ".join(f"{name}: {n}" for name, n in where.items() if n)
    many = counted(len(lines), "recording is", "recordings are")
    yield from _group(f"{many} left out ({told})", lines)


def _unavailable(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    lines, where = [], []
    for name in names:
        rows = rows_of(sources.results / name / "not_available")
        lines += [f"{name}: {line}" for line in unavailable_lines(rows)]
        where += [name] if len(rows) else []
    yield from _group(f"Analyses, or parts of them, not available ({listed(where, 20)})", lines)


def _implausible(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    lines, where = [], []
    for name in names:
        findings = sources.table(name, "plausibility")
        bad = findings[findings["verdict"] == "implausible"]
        if len(bad):
            where.append(name)
        for check, rows in bad.groupby("check", sort=True):
            worst = rows.iloc[0]
            lines.append(
                f"{name}: {check} is implausible in {len(rows)} of "
                f"{findings['recording'].nunique()} recordings (e.g. {worst['recording']}: "
                f"{worst['value']:.3g} {worst['unit']}, plausible {worst['low']:g} to "
                f"{worst['high']:g}): {worst['note']}."
            )
    many = counted(len(lines), "length or speed", "lengths or speeds")
    yield from _group(f"{many} that a body does not have ({', '.join(where)})", lines)


def _glosses(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    lines = [
        f"{name}: {line}"
        for name in names
        if sources.corpora[name].tagged
        for line in unused_glosses(sources.naert_source(name))
    ]
    yield from _group("Glosses of signs.csv that no recording has", lines)


def _tags(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    lines, many = [], 0
    for name in names:
        about = sources.table(name, "recordings")
        some = about[(about["tags_left_out"] > 0) | (about["tags_note"] != "")]
        many += int(some["tags_left_out"].sum())
        lines += [
            f"{name}, {row.recording}: {row.tags_left_out} tags left out. {row.tags_note}"
            for row in some.itertuples()
        ]
    yield from _group(f"{counted(many, 'tag', 'tags')} left out, or tiers empty", lines)


def _decided(sources: Sources, names: tuple[str, ...]) -> Iterator[Group]:
    """Yield what was decided in reading, each kind once with the recordings it was decided in."""
    lines = []
    for name in names:
        about = sources.table(name, "recordings")
        where: dict[str, list[str]] = {}
        for recording, notes in zip(about["recording"], about["notes"].fillna(""), strict=True):
            for note in str(notes).split(" | ") if notes else ():
                where.setdefault(note, []).append(str(recording))
        lines += [f"{name}: {note} ({listed(there, 5)})." for note, there in where.items()]
    yield from _group("Decided in reading the files", lines, warns=False)
