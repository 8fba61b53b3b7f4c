"""DeepLabCut's tables in HDF5, as pandas lays them out; what is none is refused."""

import pickle

import numpy as np
import pytest

from signkin import SignkinError, read_recording
from support.motion_files import LANDMARKS, SAMPLES, motion, pixels

NAMES = [("net", person, part, c) for person in "AB" for part in LANDMARKS for c in ("x", "y")]

ALL = range(len(NAMES))


@pytest.fixture
def h5py():
    return pytest.importorskip("h5py", reason="the optional library h5py is not there")


def levels(group, name, rows):
    """Write names along an axis as levels and codes."""
    group.attrs[f"{name}_variety"] = np.bytes_(b"multi")
    group.attrs[f"{name}_nlevels"] = len(rows[0])
    for i, own in enumerate(zip(*rows, strict=True)):
        there = sorted(set(own))
        group[f"{name}_level{i}"] = np.array(there, dtype="S")
        group[f"{name}_label{i}"] = np.array([there.index(v) for v in own], dtype="i1")


def fixed(h5py, path, frames=12, order=ALL):
    """Write two individuals in the layout `fixed`; the block has its columns in another order."""
    x = pixels(motion(frames)).reshape(frames, -1)
    values = np.concatenate([x, x + 1], axis=1)
    names = [NAMES[i] for i in order]
    with h5py.File(path, "w") as file:
        group = file.create_group("df_with_missing")
        group.attrs["pandas_type"] = np.bytes_(b"frame")
        group.attrs["nblocks"] = 1
        levels(group, "axis0", NAMES)
        levels(group, "block0_items", names)
        levels(group, "axis1", [("labeled-data", "v", f"img{i:03d}.png") for i in range(frames)])
        block = group.create_dataset("block0_values", data=values[:, list(order)])
        block.attrs["transposed"] = True
    return x


def test_blocks_of_several_individuals(h5py, tmp_path):
    path = tmp_path / "d.h5"
    x = fixed(h5py, path, order=list(range(len(NAMES)))[::-1])
    spec = {"rate_hz": 30, "joints": {"right_wrist": "RIGHT_WRIST", "left_wrist": "LEFT_WRIST"}}
    with pytest.raises(SignkinError, match="2 individuals; expected one of A, B"):
        read_recording(path, **spec)
    read = read_recording(path, part="B", **spec)
    assert np.array_equal(read.positions[:, 0, :2], x[:, :2] + 1)


@pytest.mark.parametrize(
    ("spoil", "match"),
    [
        (lambda f: f["df_with_missing"].attrs.modify("nblocks", 0), "not readable as a table"),
        (lambda f: f["df_with_missing"].attrs.modify("pandas_type", b"series"), "type 'serie"),
        (lambda f: f.move("df_with_missing/axis1_label2", "x"), "axis1_label2"),
        (lambda f: f["df_with_missing/axis1_label2"].write_direct(
            np.full(12, 77, dtype="i1")), "a code beyond the 12 names of level 2"),
        (lambda f: f["df_with_missing/axis1_label2"].write_direct(
            np.array([0, 2, 1, *range(3, 12)], dtype="i1")), "row 2: frame .*img002.* follows"),
        (lambda f: f.copy("df_with_missing", "again"), "2 tables in the file; expected one of aga"),
        (lambda f: f.move("df_with_missing", "group/table"), "0 tables in the file"),
    ],
)  # fmt: skip
def test_what_is_no_table_is_refused(h5py, tmp_path, spoil, match):
    path = tmp_path / "d.h5"
    fixed(h5py, path)
    with h5py.File(path, "r+") as file:
        spoil(file)
    with pytest.raises(SignkinError, match=match):
        read_recording(path, rate_hz=30, part="A")


def test_a_pickle_that_would_run_code_is_refused(h5py, tmp_path):
    made = SAMPLES["deeplabcut_h5"]
    path = tmp_path / "d.h5"
    made.write(path, motion(12))
    with h5py.File(path, "r+") as file:
        names = pickle.dumps(tmp_path.joinpath, protocol=0)
        file["df_with_missing"].attrs["non_index_axes"] = np.bytes_(names)
    with pytest.raises(SignkinError, match=r"UnpicklingError: "):
        read_recording(path, format=made.format, **made.spec)


def test_without_the_library_the_way_to_csv_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    (tmp_path / "d.h5").write_bytes(b"x")
    with pytest.raises(SignkinError, match=r"signkin\[h5\].*read_hdf\('a.h5'\).to_csv"):
        read_recording(tmp_path / "d.h5", rate_hz=30)
