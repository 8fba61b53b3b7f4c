"""The pipeline's own files of canonical recordings: Parquet, one row a frame, many recordings.

Columns: recording, frame, time_s, then `<joint>_x_m` (or `_px`), `_y_`, `_z_`,
and `<joint>_qx` to `_qw` where there are orientations. Each recording is a row
group of its own; rate, unit, hierarchy and the source of the orientations stand
in the file's metadata under the key `signkin`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from signkin.errors import SignkinError
from signkin.recording import Recording

_KEY = b"signkin"


def write_recordings(path: Path, recordings: Sequence[Recording]) -> None:
    """Write recordings of one corpus (the same joints and unit) to one file."""
    if not recordings:
        raise SignkinError("no recording to write", file=path, expected="one or more")
    first = recordings[0]
    for recording in recordings:
        if (recording.joints, recording.unit) != (first.joints, first.unit) or (
            recording.orientation_source != first.orientation_source
        ):
            raise SignkinError(
                f"{recording.name} and {first.name} differ in joints, unit or orientations",
                file=path,
                expected="the same in all recordings of a corpus",
            )
    about: dict[str, Any] = {
        "unit": first.unit,
        "joints": first.joints,
        "parents": first.parents,
        "orientation_source": first.orientation_source,
        "rates_hz": {recording.name: recording.rate_hz for recording in recordings},
    }
    notes = {recording.name: recording.notes for recording in recordings if recording.notes}
    if notes:
        about["notes"] = notes
    tables = [_table(recording) for recording in recordings]
    schema = tables[0].schema.with_metadata({_KEY: json.dumps(about).encode()})
    with pq.ParquetWriter(path, schema, compression="zstd") as writer:
        for table in tables:
            writer.write_table(table.replace_schema_metadata(schema.metadata), len(table))


def _table(recording: Recording) -> pa.Table:
    columns: dict[str, Any] = {
        "recording": pa.array([recording.name] * recording.frames),
        "frame": np.arange(recording.frames, dtype=np.int32),
        "time_s": recording.times_s,
    }
    for j, joint in enumerate(recording.joints):
        for axis, letter in enumerate("xyz"):
            columns[f"{joint}_{letter}_{recording.unit}"] = recording.positions[:, j, axis]
    if recording.orientations is not None:
        for j, joint in enumerate(recording.joints):
            for axis, letter in enumerate("xyzw"):
                columns[f"{joint}_q{letter}"] = recording.orientations[:, j, axis]
    return pa.table(columns)


def recording_names(path: Path) -> list[str]:
    """Return the names of the recordings in a file, in the order they were written."""
    return list(_about(pq.ParquetFile(path), path)["rates_hz"])


def read_recordings(path: Path, names: Iterable[str] | None = None) -> Iterator[Recording]:
    """Yield recordings of a file one by one, all or those named."""
    file = pq.ParquetFile(path)
    about = _about(file, path)
    joints = tuple(about["joints"])
    wanted = set(about["rates_hz"]) if names is None else set(names)
    parents = about["parents"]
    for group, (name, rate_hz) in enumerate(about["rates_hz"].items()):
        if name not in wanted:
            continue
        table = file.read_row_group(group)
        letters = [f"{joint}_{axis}_{about['unit']}" for joint in joints for axis in "xyz"]
        turned = about["orientation_source"] != "none"
        quaternions = [f"{joint}_q{axis}" for joint in joints for axis in "xyzw"]
        yield Recording(
            name=name,
            rate_hz=rate_hz,
            joints=joints,
            positions=_block(table, letters, 3),
            orientations=_block(table, quaternions, 4) if turned else None,
            orientation_source=about["orientation_source"],
            unit=about["unit"],
            parents=None if parents is None else tuple(parents),
            notes=tuple(about.get("notes", {}).get(name, ())),
        )


def _block(table: pa.Table, columns: list[str], width: int) -> np.ndarray:
    values = np.column_stack([table.column(column).to_numpy() for column in columns])
    return np.ascontiguousarray(values).reshape(len(values), -1, width)


def _about(file: pq.ParquetFile, path: Path) -> dict[str, Any]:
    metadata = file.schema_arrow.metadata or {}
    if _KEY not in metadata:
        raise SignkinError(
            "no signkin metadata", file=path, expected="a file written by the ingest rule"
        )
    about: dict[str, Any] = json.loads(metadata[_KEY])
    return about
