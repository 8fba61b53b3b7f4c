"""DeepLabCut's tables (.csv, .h5), in pixels; SLEAP and Lightning Pose export the same.

Columns are named in rows: scorer, individuals (where there are several; `part` picks one),
bodyparts, coords. Rows are frames, numbered or named by image. The .h5 holds the same table as
pandas writes it (`h5_table`, wants the optional library h5py).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.chosen import pick
from signkin.io.h5_table import read_h5_table
from signkin.io.points import Points, source_motion, threshold_of
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.table import FIRST_LINE, Layout, numbers_of
from signkin.io.text import quoted
from signkin.io.tracked import body_of, check_seen, header_of

LIKELY = 0.6  # DeepLabCut's own `pcutoff`
_NUMBERED = re.compile(r"(?P<video>.*?)(?P<frame>[0-9]{1,15})(?:\.0+|\.[A-Za-z]{2,4})?", re.DOTALL)


@dataclass(frozen=True)
class _Columns:
    """Names of the columns, all of one length; place: where they stand, for errors."""

    owners: Sequence[str]
    parts: Sequence[str]
    coords: Sequence[str]
    place: str


@motion_reader("deeplabcut_csv")
def read_deeplabcut_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    confidence_threshold: float = LIKELY,
    separator: str = "comma",
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read a table as text. Less likely than confidence_threshold is a gap."""
    layout = Layout(separator, decimal, encoding=encoding)
    rows = header_of(path, layout, 4)
    titles = [row[0].lower() for row in rows]
    if "bodyparts" not in titles or "coords" not in titles:
        raise SignkinError(
            f"the rows {listed(titles)}", place="line 1", expected="scorer, bodyparts, coords"
        )
    parts, coords = rows[titles.index("bodyparts")], rows[titles.index("coords")]
    owners = rows[titles.index("individuals")] if "individuals" in titles else [""] * len(parts)
    before = next((i for i, axis in enumerate(coords) if axis == "x"), 0)
    columns = _Columns(
        owners[before:], parts[before:], coords[before:], f"line {titles.index('coords') + 1}"
    )
    header = [str(i) for i in range(len(coords))]
    index = header[: max(before, 1)]

    def values(chosen: Sequence[int]) -> NDArray[np.float64]:
        wanted = [str(before + i) for i in chosen]
        first = titles.index("coords") + FIRST_LINE
        table, _ = body_of(path, layout, header, [*wanted, *index], first)
        names = ["/".join(cells) for cells in zip(*(table[i] for i in index), strict=True)]
        _check_index(names, [f"line {i + FIRST_LINE}" for i in table.index])
        return numbers_of(table, wanted)

    return _motion(columns, values, joints, part, confidence_threshold)


@motion_reader("deeplabcut_h5", suffixes=(".h5",))
def read_deeplabcut_h5(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    confidence_threshold: float = LIKELY,
    key: str | None = None,
) -> SourceMotion:
    """Read a table as HDF5; key: its name in the file, where there are several."""
    table = read_h5_table(path, key)
    if len(table.columns[0]) not in (3, 4):
        raise SignkinError(
            f"columns of {len(table.columns[0])} names",
            place=f"table {table.key}",
            expected="scorer, (individuals,) bodyparts, coords",
        )
    owners = [name[1] if len(name) == 4 else "" for name in table.columns]
    columns = _Columns(
        owners, [n[-2] for n in table.columns], [n[-1] for n in table.columns], f"table {table.key}"
    )
    _check_index(table.index, [f"row {i + 1}" for i in range(len(table.index))])
    return _motion(
        columns, lambda chosen: table.values[:, list(chosen)], joints, part, confidence_threshold
    )


def _motion(
    columns: _Columns,
    values: Callable[[Sequence[int]], NDArray[np.float64]],
    joints: Mapping[str, str] | None,
    part: str | None,
    confidence_threshold: float,
) -> SourceMotion:
    """Return the motion of a table; values: places of columns -> their numbers, (F, C)."""
    limit = threshold_of(confidence_threshold)
    places = _places(columns, part)
    names = tuple(dict.fromkeys(name for name, axis in places if axis == "x"))
    canonical, chosen = pick(names, joints)
    axes = ("x", "y", "z") if all((names[i], "z") in places for i in chosen) else ("x", "y")
    lost = [names[i] for i in chosen for axis in axes if (names[i], axis) not in places]
    if lost or not names:
        raise SignkinError(f"no y of {listed(lost)}", place="row coords", expected="x and y")
    wanted = [places[names[i], axis] for i in chosen for axis in axes]
    trust = {
        name: places[names[i], "likelihood"]
        for name, i in zip(canonical, chosen, strict=True)
        if (names[i], "likelihood") in places
    }
    found = values([*wanted, *trust.values()])
    positions = np.zeros((len(found), len(chosen), 3))
    positions[..., : len(axes)] = found[:, : len(wanted)].reshape(len(found), len(chosen), -1)
    seen = {name: found[:, len(wanted) + i] for i, name in enumerate(trust)}
    check_seen(seen)
    masked = sum(int((values < limit).sum()) for values in seen.values())
    note = f"{masked} points less likely than {limit:g} are gaps"
    return source_motion(
        Points(
            joints=canonical,
            positions=positions,
            flat=(len(axes) == 2,) * len(canonical),
            confidence=seen,
            unit="px" if len(axes) == 2 else None,
            notes=(note,) if masked else (),
        ),
        confidence_threshold=confidence_threshold,
    )


def _places(columns: _Columns, part: str | None) -> dict[tuple[str, str], int]:
    """Return (body part, coordinate) -> place, of one individual."""
    people = list(dict.fromkeys(columns.owners))
    if len(people) > 1 and part is None:
        raise SignkinError(
            f"{len(people)} individuals", place="part", expected=f"one of {listed(people)}"
        )
    if len(people) > 1 and part not in people:
        raise SignkinError(
            f"no individual {quoted(part)}", place="part", expected=listed(p for p in people if p)
        )
    places: dict[tuple[str, str], int] = {}
    for i, name in enumerate(zip(columns.parts, columns.coords, strict=True)):
        if len(people) < 2 or columns.owners[i] == part:
            if name in places:
                raise SignkinError(
                    f"{quoted(name[0])} has two columns {name[1]}",
                    place=columns.place,
                    expected="each body part once; two scorers in one table are two recordings",
                )
            places[name] = i
    return places


def _check_index(names: Sequence[str], places: Sequence[str]) -> None:
    """Refuse frames that do not follow one another, by number or by the image's name.

    Images are `labeled-data/video/img0001.png`, in one cell or in three.
    """
    before: tuple[str, int] | None = None
    for i, name in enumerate(names):
        found = _NUMBERED.fullmatch(name.strip().rstrip("/"))
        if found is None:
            return  # names without numbers say nothing
        now = (found["video"], int(found["frame"]))
        if before is not None and (now[0] != before[0] or now[1] - before[1] != 1):
            raise SignkinError(
                f"frame {quoted(name)} follows {quoted(names[i - 1])}",
                place=places[i],
                expected="the frames of one video, whose numbers rise by 1",
            )
        before = now
