import errno

import pytest

from signkin.results import gathered
from signkin.results.gathered import gather_files


@pytest.fixture
def shards(tmp_path):
    for shard, name in (("0001", "b.eaf"), ("0002", "a.eaf")):
        folder = tmp_path / shard
        folder.mkdir()
        (folder / name).write_bytes(shard.encode())
        (folder / ".snakemake_timestamp").touch()
    return [tmp_path / "0001", tmp_path / "0002"]


def test_files_of_shards_lie_once_on_the_disk(shards, tmp_path):
    gather_files(shards, tmp_path / "eaf")
    assert sorted(p.name for p in (tmp_path / "eaf").iterdir()) == ["a.eaf", "b.eaf"]
    assert (tmp_path / "eaf" / "a.eaf").samefile(shards[1] / "a.eaf")


def test_they_are_copied_where_there_are_no_hard_links(shards, tmp_path, monkeypatch):
    def refused(source, target):
        raise OSError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(gathered.os, "link", refused)
    gather_files(shards, tmp_path / "eaf")
    assert (tmp_path / "eaf" / "a.eaf").read_bytes() == b"0002"
    assert not (tmp_path / "eaf" / "a.eaf").samefile(shards[1] / "a.eaf")


def test_two_files_of_one_name_are_refused(shards, tmp_path):
    (shards[1] / "b.eaf").touch()
    with pytest.raises(FileExistsError, match=r"b\.eaf"):
        gather_files(shards, tmp_path / "eaf")
    assert (tmp_path / "eaf" / "b.eaf").read_bytes() == b"0001"
