"""What a run consists of."""

import re
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


def test_beyond_9999_shards_names_grow(plan, root):
    corpus = plan.corpora["auslan-hq"]
    entries = tuple(replace(corpus.entries[0], recording=f"r{i}") for i in range(10_001))
    many = replace(plan, corpora={"many": replace(corpus, entries=entries)},
                   settings=Settings(recordings_per_job=1))  # fmt: skip
    shards = many.shards("many")
    assert [shards[i] for i in (0, 9998, 9999, 10_000)] == ["0001", "9999", "10000", "10001"]
    assert many.names("many", shards[-1]) == ["r10000"]
    rules = (root / "workflow" / "rules" / "common.smk").read_text()
    allowed = re.search(r'^    shard=r"(.*?)",', rules, re.MULTILINE)
    assert "{" not in allowed[1]  # braces end a wildcard of Snakemake
    assert all(re.fullmatch(allowed[1], shard) for shard in shards)
