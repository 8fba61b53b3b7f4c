# What a run consists of, found out once: corpora, their files, what is missing.
from signkin.errors import SignkinError
from signkin.exhibits import exhibits, files, of_groups
from signkin.stages.plan import make_plan
from snakemake.exceptions import WorkflowError

try:
    PLAN = make_plan(config, workflow.basedir)
except SignkinError as error:
    raise WorkflowError(f"signkin: {error}") from None


wildcard_constraints:
    corpus="[A-Za-z0-9._-]+",
    shard=r"\d{4}",


def of_shards(pattern):
    """Return an input function: the files of all shards of a corpus."""
    return lambda w: collect(pattern, corpus=w.corpus, shard=PLAN.shards(w.corpus))


def figure_files(paper, *groups, folder="<results>/{paper}/{{corpus}}"):
    """Return the files of the figures that papers/<paper>/exhibits.yaml lists in some groups."""
    try:
        listing = of_groups(exhibits(PLAN.papers / paper), *groups)
    except SignkinError as error:
        raise WorkflowError(f"signkin: {error}") from None
    return files(listing, folder.format(paper=paper))
