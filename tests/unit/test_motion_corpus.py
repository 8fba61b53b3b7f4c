"""A corpus whose files came from anywhere: what may lie where, and what is left out how."""

from __future__ import annotations

import hashlib
import io
import tarfile

import numpy as np
import pytest
import yaml

from signkin import SignkinError
from signkin.corpus import load_corpus
from signkin.corpus_files import check_files
from signkin.io.store import read_recordings, write_recordings
from signkin.settings import Settings
from signkin.stages import ingest as ingest_module
from signkin.stages.ingest import ingest
from signkin.stages.plan import Plan
from support.motion_files import COLUMNS, SAMPLES, motion, write_bvh, write_csv


@pytest.fixture
def made(tmp_path):
    """Return a function that writes a corpus of tables and loads it: (corpus, data folder)."""
    folder, data = tmp_path / "mine", tmp_path / "data"
    folder.mkdir()
    data.mkdir()

    def make(names=("a", "b", "c"), rows=None, **settings):
        motion_section = {
            "format": "csv", "unit": "m", "joints": COLUMNS, "options": {"time_column": "time"},
        }  # fmt: skip
        motion_section.update(settings.pop("motion", {}))
        text = {
            "title": "t", "language": "l", "licence": "none", "citation": "c", "noise_sd": 0.001,
            "motion": motion_section, **settings,
        }  # fmt: skip
        (folder / "corpus.yaml").write_text(yaml.safe_dump(text))
        lines = rows or [f"{n},s1,{n}.csv" for n in names]
        (folder / "recordings.csv").write_text("\n".join(["recording,signer,motion", *lines, ""]))
        for name in names:
            if not (data / f"{name}.csv").exists():
                write_csv(data / f"{name}.csv", motion())
        return load_corpus(folder), data

    return make


def test_files_that_lead_out_of_the_data_folder_are_refused(made, tmp_path):
    secret = tmp_path / "secret.csv"
    write_csv(secret, motion())
    for name in ("../secret.csv", str(secret), "a/../../secret.csv"):
        corpus, data = made(rows=[f"r1,s1,{name}"])
        with pytest.raises(SignkinError, match=r"recordings.csv, line 2: .*leads out of the data"):
            check_files(corpus, data)
        with pytest.raises(SignkinError, match="leads out of the data folder"):
            ingest(corpus, data, corpus.entries)


def test_links_out_of_the_data_folder_and_in_rings_are_refused(made, tmp_path):
    secret = tmp_path / "secret.csv"
    write_csv(secret, motion())
    corpus, data = made(names=(), rows=["r1,s1,out.csv"])
    (data / "out.csv").symlink_to(secret)
    with pytest.raises(SignkinError, match="leads out of the data folder"):
        check_files(corpus, data)
    (data / "out.csv").unlink()
    (data / "out.csv").symlink_to(data / "out.csv")
    with pytest.raises(SignkinError, match="line 2"):
        check_files(corpus, data)
    (data / "out.csv").unlink()
    (data / "out.csv").symlink_to(data / "nothing.csv")
    with pytest.raises(SignkinError, match="there is no file"):
        check_files(corpus, data)
    # A link within the folder is a file like any other, and so is a folder that is one itself.
    write_csv(data / "nothing.csv", motion())
    check_files(corpus, data)
    (tmp_path / "elsewhere").symlink_to(data)
    check_files(corpus, tmp_path / "elsewhere")


def test_what_goes_wrong_in_one_recording_is_skipped(made, monkeypatch, capfd):
    names = ("a", "b", "c", "d", "e")
    corpus, data = made(
        names=names,
        rows=[f"{n},s1,{n}.csv" for n in names] + ["f,s1,../f.csv"],
        on_error="skip",
        checksums={"d.csv": hashlib.sha256(b"other").hexdigest()},
    )
    (data / "b.csv").unlink()
    (data / "c.csv").write_text("time,x\n0,1\n")
    read = ingest_module.read_recording

    def breaks(path, **spec):
        if path.name == "e.csv":
            raise ZeroDivisionError("a fault of this package\nover two lines")
        return read(path, **spec)

    monkeypatch.setattr(ingest_module, "read_recording", breaks)
    check_files(corpus, data)
    done = ingest(corpus, data, corpus.entries)
    assert [r.name for r in done.recordings] == ["a"]
    assert [(row["recording"], row["stage"]) for row in done.excluded] == [
        (name, "reading") for name in "bcdef"
    ]
    reasons = {row["recording"]: row["reason"] for row in done.excluded}
    assert "there is no file" in reasons["b"] and "no column" in reasons["c"]
    assert "SHA-256" in reasons["d"] and "leads out" in reasons["f"]
    assert reasons["e"] == "ZeroDivisionError: a fault of this package over two lines"
    assert "Traceback" in capfd.readouterr().err
    assert not any("\n" in reason for reason in reasons.values())


def test_without_being_asked_to_nothing_is_skipped(made, monkeypatch):
    corpus, data = made()
    (data / "b.csv").write_text("time,x\n0,1\n")
    with pytest.raises(SignkinError, match="no column"):
        ingest(corpus, data, corpus.entries)
    monkeypatch.setattr(ingest_module, "read_recording", lambda *a, **k: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        ingest(corpus, data, corpus.entries)


def test_files_that_are_not_there_are_no_input_of_a_run_that_skips(made, tmp_path):
    corpus, data = made(on_error="skip")
    (data / "b.csv").unlink()
    plan = Plan({"mine": corpus}, {"mine": data}, {}, Settings(), tmp_path, tmp_path)
    assert plan.files("mine", "0001") == [str(data / "a.csv"), str(data / "c.csv")]
    assert plan.corpora_files("mine") == plan.files("mine", "0001")


def test_what_was_decided_in_reading_stands_in_the_tables(made, tmp_path):
    corpus, data = made(motion={"rate_hz": {"use": 60, "instead_of_file": True}})
    done = ingest(corpus, data, corpus.entries)
    note = "the file says 50 Hz; overruled by the declared 60 Hz"
    assert done.table("recordings")["notes"].tolist() == [note] * 3
    assert done.table("recordings")["rate_hz"].tolist() == [60.0] * 3
    write_recordings(tmp_path / "r.parquet", done.recordings)
    assert [r.notes for r in read_recordings(tmp_path / "r.parquet")] == [(note,)] * 3


def test_pixels_are_declared_in_the_corpus(made):
    options = {"time_column": "time", "image_size": [9, 9]}
    corpus, data = made(motion={"unit": "px", "options": options})
    assert ingest(corpus, data, corpus.entries).recordings[0].unit == "px"
    sample = SAMPLES["openpose_csv"]
    sample.write(data / "p.csv", motion())
    section = {"format": "openpose_csv", **sample.spec}
    section["options"] = {"landmarks": section.pop("landmarks")}
    corpus, data = made(names=(), rows=["r,s1,p.csv"], motion={**section, "unit": "px"})
    assert ingest(corpus, data, corpus.entries).recordings[0].unit == "px"
    corpus.settings["motion"].pop("unit")
    with pytest.raises(SignkinError, match=r"key motion.unit: the positions are in px"):
        ingest(corpus, data, corpus.entries)


def test_parts_of_one_table_are_told_apart(made):
    corpus, _ = made()
    (corpus.folder / "recordings.csv").write_text(
        "recording,signer,motion,part\nr1,s1,a.csv,1\nr2,s1,a.csv,2\n"
    )
    with pytest.raises(SignkinError, match=r"line 3: r2 and r1 are parts of a.csv"):
        load_corpus(corpus.folder)


@pytest.mark.parametrize("name", ["corpus.yaml", "recordings.csv"])
def test_a_description_in_another_encoding_is_named_by_line(made, tmp_path, name):
    corpus, _ = made()
    path = corpus.folder / name
    path.write_bytes(path.read_bytes() + "# höhe\n".encode("latin-1"))
    with pytest.raises(SignkinError, match=rf"{name}, line \d+: (the )?byte 0xf6 is not UTF-8"):
        load_corpus(corpus.folder)


def test_a_folder_of_files_has_a_checksum(made):
    sample = SAMPLES["openpose_json"]
    spec = dict(sample.spec)
    corpus, data = made(names=(), rows=["r,s1,v"], motion={**spec, "format": "openpose_json",
                        "unit": "px", "options": {}}, checksums={"v": "0" * 64})  # fmt: skip
    sample.write(data / "v", motion(5))
    with pytest.raises(SignkinError, match="the SHA-256 of v is ") as error:
        ingest(corpus, data, corpus.entries)
    found = error.value.found.split()[-1]
    corpus.settings["checksums"]["v"] = found
    assert ingest(corpus, data, corpus.entries).recordings[0].frames == 5
    (data / "v" / "v_000000000002_keypoints.json").write_text("{}")
    with pytest.raises(SignkinError, match="the SHA-256 of v is "):
        ingest(corpus, data, corpus.entries)


def test_archives_neither_climb_nor_link(tmp_path):
    from signkin import read_recording

    spec = {"format": "tsd", "rate_hz": 50, "joints": {"right_wrist": "right"}}
    path = tmp_path / "a.tar.gz"
    row = ("\t".join(["1"] * 22) + "\n").encode() * 3
    with tarfile.open(path, "w:gz") as archive:
        for name in ("../../up.tsd", "in.tsd"):
            member = tarfile.TarInfo(name)
            member.size = len(row)
            archive.addfile(member, io.BytesIO(row))
        for name, kind in (("soft.tsd", tarfile.SYMTYPE), ("hard.tsd", tarfile.LNKTYPE)):
            member = tarfile.TarInfo(name)
            member.type, member.linkname = kind, "/etc/passwd"
            archive.addfile(member)
    # Nothing is unpacked: a name that climbs is a name.
    assert read_recording(path, part="../../up.tsd", **spec).frames == 3
    assert not (tmp_path.parent.parent / "up.tsd").exists()
    for name in ("soft.tsd", "hard.tsd"):
        with pytest.raises(SignkinError, match=f"no member '{name}' among 2 in the archive"):
            read_recording(path, part=name, **spec)
    whole = path.read_bytes()
    for damage in (whole[:60], whole[:30] + b"\xff" * 20 + whole[50:], b"\x1f\x8b" + b"\0" * 50):
        path.write_bytes(damage)
        with pytest.raises(SignkinError, match="not readable as a tar archive"):
            read_recording(path, part="in.tsd", **spec)


def test_an_archive_that_would_fill_the_memory_is_refused(tmp_path, monkeypatch):
    from signkin import read_recording
    from signkin.io import archive

    monkeypatch.setattr(archive, "LARGEST_BYTES", 100)
    sample = SAMPLES["tsd"]
    sample.write(tmp_path / "t.tar.gz", motion())
    with pytest.raises(SignkinError, match="more than 0 MB unpacked"):
        read_recording(tmp_path / "t.tar.gz", format="tsd", **sample.spec)


def test_a_text_that_would_fill_the_memory_is_refused(tmp_path, monkeypatch):
    from signkin import read_recording
    from signkin.io import text

    path = tmp_path / "m.bvh"
    write_bvh(path, motion())
    monkeypatch.setattr(text, "LARGEST_BYTES", 100)
    with pytest.raises(SignkinError, match="0 MB in one file"):
        read_recording(path, unit="cm")


def test_noise_is_measured_in_every_axis():
    from signkin import Recording
    from signkin.kinematics import measure_noise

    rng = np.random.default_rng(1)
    noise = rng.normal(size=(4000, 3, 3)) * [0.001, 0.002, 0.004]
    slow = motion(4000)
    names = ("right_wrist", "left_wrist", "right_elbow")
    recording = Recording(name="r", rate_hz=200, joints=names, positions=slow + noise)
    found = measure_noise(recording)
    assert found.axes == pytest.approx((0.001, 0.002, 0.004), rel=0.05)
    assert found.sd == pytest.approx(np.sqrt(7) * 0.001, rel=0.05)
    assert found.correlation == pytest.approx(-0.75, abs=0.03)
    held = Recording(name="r", rate_hz=200, joints=names, positions=np.zeros((100, 3, 3)))
    with pytest.raises(SignkinError, match="more than half of the third differences are 0"):
        measure_noise(held)
    short = Recording(name="r", rate_hz=200, joints=names, positions=slow[:20])
    with pytest.raises(SignkinError, match="17 stretches of four frames"):
        measure_noise(short)


def test_a_recording_is_cut_at_long_gaps():
    from signkin import Recording
    from signkin.kinematics import cut_at_gaps

    x = motion(300)
    names = ("right_wrist", "left_wrist", "right_elbow")
    x[100:120, 0] = np.nan  # 0.4 s at 50 Hz
    x[200:203, 1] = np.nan  # short
    x[290:, 0] = np.nan
    recording = Recording(name="r", rate_hz=50, joints=names, positions=x)
    first, second = cut_at_gaps(recording, 0.1)
    assert (first.name, first.frames, second.name, second.frames) == ("r-1", 100, "r-2", 170)
    assert np.array_equal(second.positions, x[120:290], equal_nan=True)
    assert second.notes == ("cut from 2.400 s to 5.800 s",)
    assert cut_at_gaps(recording, 1.0) == [recording]
    with pytest.raises(SignkinError, match=r"no stretch of 9 s without a gap over 0\.1 s"):
        cut_at_gaps(recording, 0.1, shortest_s=9)
