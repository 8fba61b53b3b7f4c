# What a run consists of, found out once: corpora, their files, what is missing.
from pathlib import Path

from signkin.errors import SignkinError
from signkin.rule_params import told_as_text
from signkin.stages.plan import make_plan
from signkin.stages.remote import Remote
from signkin.yaml_file import read_yaml
from snakemake.exceptions import WorkflowError

try:
    for file in workflow.configfiles:  # Snakemake takes a key that stands twice
        read_yaml(Path(file))
    PLAN = make_plan(
        config, workflow.basedir, remote=Remote(storage, lambda file: exists(file))
    )
except SignkinError as error:
    raise WorkflowError(f"signkin: {error}") from None

# Each rule takes the sections that it needs, so that a changed key reruns what depends on it alone.
SETTINGS = PLAN.settings

# The longest job of a run, order_choices, stands at the end of a chain of jobs: they go first.
LONGEST_CHAIN = 20


wildcard_constraints:
    corpus="[A-Za-z0-9._-]+",
    shard=r"\d\d\d\d+",  # \d{4,} has braces, which end a wildcard


def of_shards(*patterns):
    """Return an input function: the files of all shards of a corpus, shard by shard."""

    def files(wildcards):
        shards = PLAN.shards(wildcards.corpus)
        each = [collect(patterns, corpus=wildcards.corpus, shard=s) for s in shards]
        return [file for shard in each for file in shard]

    return files
