"""Recordings and results in a storage service: an S3 server on loopback that is often busy.

    pytest -v tests/workflow/test_storage.py

wants the extra `s3` and moto (pip install 'signkin[s3]' 'moto[server,s3]'), which are not in
requirements.lock.
"""

from __future__ import annotations

import shutil

import pytest

from support.less import LESS
from support.loopback_s3 import loopback, why_not
from support.runs import checked, prepare, run, signkin, write_mini

LIMIT_S = 3600  # two whole runs of a mini corpus: minutes, more on a busy machine

pytestmark = pytest.mark.skipif(bool(why_not()), reason=why_not())


@pytest.fixture
def server(monkeypatch):
    """A server that answers each of the first 40 requests 503 twice before it serves."""
    with loopback(refusals=2) as running:
        for name, value in running.environment.items():
            monkeypatch.setenv(name, value)
        yield running


def test_a_run_from_storage_to_storage_gives_the_results_of_a_local_one(tmp_path, server):
    local = prepare(tmp_path / "local", corpora=["mini"], **LESS)
    write_mini(local, tmp_path / "data")
    stored = prepare(tmp_path / "stored", corpora=["mini"], data_dir="s3://signs/data",
                     results_store="s3://signs/mine/results", **LESS)  # fmt: skip
    shutil.copytree(local / "corpora", stored / "corpora")
    server.put(tmp_path / "data", "signs", "data")
    server.bucket("signs").put_object(Key="mine/results/of_an_older_run.csv", Body=b"a\n1\n")
    checked(run(local, data=tmp_path / "data", timeout=LIMIT_S))
    checked(run(stored, timeout=LIMIT_S))
    assert not list(stored.rglob("m1.csv"))  # fetched, and taken away again
    fetched = tmp_path / "fetched"
    server.get("signs", "mine/results", fetched)
    compared = signkin("compare", str(local / "results"), str(fetched), folder=tmp_path)
    assert compared.status == 0, compared.text
    refused = {path for (_, path), times in server.refused.items() if times == 2}
    assert "/signs/data/mini/m1.csv" in refused
    assert any(path.startswith("/signs/mine/results/") for path in refused)
    again = checked(run(stored, timeout=LIMIT_S))
    assert "Nothing to be done" in again.text


def test_an_address_that_no_plugin_knows_is_told(tmp_path):
    folder = prepare(tmp_path, corpora=["mini"], data_dir="zz://signs/data")
    write_mini(folder, tmp_path / "data")
    done = run(folder)
    assert done.status == 1
    assert "signkin: Snakemake has no storage plugin for zz://signs/data/mini/m1.csv" in done.text
