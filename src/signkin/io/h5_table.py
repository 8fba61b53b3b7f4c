"""Tables that pandas keeps in HDF5 files, read by h5py (optional: `signkin[h5]`) without PyTables.

pandas writes two layouts. `table`: one compound dataset; the names of the columns are pickled, as
lists of tuples of text. `fixed`: a dataset a block of values; names are levels and codes. Pickles
are read without any class or function, so that a file cannot run code. Source: pandas.io.pytables,
class HDFStore and below.
"""

from __future__ import annotations

import io
import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.binary import damage_told
from signkin.io.text import content_of, quoted

MOST_VALUES = 200_000_000  # of a table; more fit no computer's memory twice


@dataclass(frozen=True, eq=False)
class H5Table:
    """A table: its key, names of columns (a tuple of levels each), rows by name, values (F, C)."""

    key: str
    columns: list[tuple[str, ...]]
    index: list[str]
    values: NDArray[np.float64]


class _Plain(pickle.Unpickler):
    """Reads lists, tuples, texts and numbers, and nothing that could do anything."""

    def find_class(self, module: str, name: str) -> Any:
        raise pickle.UnpicklingError(f"{module}.{name}")


def read_h5_table(path: Path, key: str | None = None) -> H5Table:
    """Return the table of a file; key: its name, where the file has several.

    Raises SignkinError for a file that is none, or whose table is of another layout.
    """
    try:
        import h5py
    except ImportError:
        raise SignkinError(
            "the library h5py is not there",
            file=path,
            todo="pip install 'signkin[h5]', or save the table as CSV: "
            "pandas.read_hdf('a.h5').to_csv('a.csv').",
        ) from None
    content = content_of(path)
    whole = "a whole .h5 file as DeepLabCut writes it"
    with (
        damage_told("a table of pandas", content, whole),
        h5py.File(io.BytesIO(content), "r") as file,
    ):
        name = _chosen(file, key)
        group = file[name]
        kind = _text(group.attrs.get("pandas_type", b""))
        if kind == "frame_table":
            return _of_table(group, name)
        if kind == "frame":
            return _of_blocks(group, name)
    raise SignkinError(
        f"the table {name} is of the type {quoted(kind)}",
        place="HDF5",
        expected="frame or frame_table, as pandas writes it",
        todo="Save it as CSV: pandas.read_hdf('a.h5').to_csv('a.csv').",
    )


def _chosen(file: Any, key: str | None) -> str:
    tables = [str(name) for name in file if "pandas_type" in file[name].attrs]
    if key is not None and key in tables:
        return key
    if key is None and len(tables) == 1:
        return tables[0]
    raise SignkinError(
        f"{len(tables)} tables in the file" if key is None else f"no table {quoted(key)}",
        place="options, key",
        expected=f"one of {listed(tables)}" if tables else "a table as DeepLabCut writes it",
    )


def _text(value: Any) -> str:
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def _unpickled(value: Any) -> Any:
    return _Plain(io.BytesIO(bytes(value)), encoding="utf-8").load()


def _names(value: Any) -> list[tuple[str, ...]]:
    """Return names of columns, which are tuples of text."""
    names = _unpickled(value)
    if not isinstance(names, list) or not all(isinstance(name, tuple) for name in names):
        raise ValueError("the columns have no levels of names")
    return [tuple(str(level) for level in name) for name in names]


def _of_table(group: Any, key: str) -> H5Table:
    """Return a table of the layout `table`: a row a record of index and blocks of values."""
    records = group["table"]
    fields = [name for name in records.dtype.names or () if name.startswith("values_block_")]
    _check_size(records.shape[0] * records.dtype.itemsize // 8)
    rows = records[()]
    blocks, names = [], []
    for field in fields:
        own = _names(records.attrs[f"{field}_kind"])
        block = np.asarray(rows[field], dtype=float).reshape(len(rows), -1)
        if block.shape[1] != len(own):
            raise ValueError(f"{block.shape[1]} columns, {len(own)} names")
        blocks.append(block)
        names += own
    (order,) = [_names_of_axis(axis) for axis in _unpickled(group.attrs["non_index_axes"])]
    return _table(key, names, np.concatenate(blocks, axis=1), [_cell(v) for v in rows["index"]],
                  order)  # fmt: skip


def _names_of_axis(axis: Any) -> list[tuple[str, ...]]:
    return [tuple(str(level) for level in name) for name in axis[1]]


def _of_blocks(group: Any, key: str) -> H5Table:
    """Return a table of the layout `fixed`."""
    blocks, names = [], []
    for i in range(min(int(group.attrs["nblocks"]), 1000)):
        values = group[f"block{i}_values"]
        _check_size(int(np.prod(values.shape)))
        block = np.asarray(values[()], dtype=float)
        if not bool(values.attrs.get("transposed", False)):
            block = block.T
        own = _axis(group, f"block{i}_items")
        if block.ndim != 2 or block.shape[1] != len(own):
            raise ValueError(f"values of shape {block.shape}, {len(own)} names")
        blocks.append(block)
        names += own
    index = ["/".join(levels) for levels in _axis(group, "axis1")]
    return _table(key, names, np.concatenate(blocks, axis=1), index, _axis(group, "axis0"))


def _axis(group: Any, name: str) -> list[tuple[str, ...]]:
    """Return the names along an axis: of one level, or of levels that codes refer to."""
    if _text(group.attrs[f"{name}_variety"]) != "multi":
        return [(_cell(value),) for value in group[name][()]]
    levels = []
    for i in range(min(int(group.attrs[f"{name}_nlevels"]), 10)):
        values = [_cell(value) for value in group[f"{name}_level{i}"][()]]
        codes = [int(code) for code in group[f"{name}_label{i}"][()]]
        if any(not 0 <= code < len(values) for code in codes):
            raise ValueError(f"a code beyond the {len(values)} names of level {i}")
        levels.append([values[code] for code in codes])
    return list(zip(*levels, strict=True))


def _cell(value: Any) -> str:
    return _text(value) if isinstance(value, bytes) else f"{value}"


def _check_size(values: int) -> None:
    if values > MOST_VALUES:
        raise SignkinError(
            f"{values} values in the table", place="HDF5", expected=f"{MOST_VALUES} or fewer"
        )


def _table(
    key: str,
    names: list[tuple[str, ...]],
    values: NDArray[np.float64],
    index: list[str],
    order: list[tuple[str, ...]],
) -> H5Table:
    """Return the table with its columns in the order of the whole, and whole."""
    if sorted(names) != sorted(order) or len(index) != len(values) or not names:
        raise ValueError(f"{len(names)} columns and {len(index)} rows, which are not all there")
    if len(set(names)) == len(names):
        at = {name: i for i, name in enumerate(names)}
        values, names = values[:, [at[name] for name in order]], list(order)
    return H5Table(key, names, index, values)
