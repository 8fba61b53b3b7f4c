"""What a run consists of."""

from dataclasses import replace

import pytest

from signkin import SignkinError
from signkin.corpus import load_corpora
from signkin.settings import Settings
from signkin.stages.plan import Plan


@pytest.fixture(scope="module")
def plan(root):
    corpora = load_corpora(root / "corpora")
    return Plan(corpora, {}, {}, settings=Settings(), root=root, papers=root / "papers")


def test_each_simulator_has_its_corpus(plan):
    assert plan.simulated == {"lsf-sim": "lsf-sim", "isl-sim": "isl-sim"}
    real = {name: c for name, c in plan.corpora.items() if c.simulator is None}
    assert replace(plan, corpora=real).simulated == {}


def test_two_corpora_of_one_simulator_are_refused(plan):
    corpora = {**plan.corpora, "again": plan.corpora["isl-sim"]}
    with pytest.raises(SignkinError, match="simulator isl-sim makes isl-sim and again; expected"):
        _ = replace(plan, corpora=corpora).simulated


def test_corpora_of_single_signs_have_no_tags(plan):
    assert set(plan.single_signs) == {"auslan-hq", "isl-kinect", "isl-sim"}
    assert set(plan.single_signs) < set(plan.untagged)


def test_thousands_of_recordings_share_a_few_jobs(plan):
    assert plan.shards("auslan-hq") == ["0001", "0002", "0003"]
    names = [name for shard in plan.shards("auslan-hq") for name in plan.names("auslan-hq", shard)]
    assert names == [entry.recording for entry in plan.corpora["auslan-hq"].entries]
