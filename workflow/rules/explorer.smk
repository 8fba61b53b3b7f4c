# A page a recording: speeds, tags, boundaries, and a skeleton that plays in time with them.
from signkin.explorer.sources import ExplorerSettings


def where(corpora, output):
    """Return an input function: an output of another rule, for these corpora alone."""
    return branch(lambda w: w.corpus in corpora, then=output, otherwise=[])


def posteriors_of(wildcards):
    """Return the posteriors of a corpus of single signs, a file a shard."""
    if wildcards.corpus not in PLAN.single_signs:
        return []
    return of_shards(rules.bin_single_signs.output.posteriors)(wildcards)


rule explorer:
    """Recordings to look at, a page each."""
    input:
        recordings_of=of_shards(rules.ingest.output.recordings),
        frames=of_shards(rules.kinematics.output.frames),
        posteriors=posteriors_of,
        recordings=rules.gather.output.recordings,
        intervals=rules.gather.output.intervals,
        minima=rules.gather.output.minima,
        plausibility=rules.gather.output.plausibility,
        excluded=rules.gather.output.excluded,
        boundaries=where(PLAN.tagged, rules.naert_tables.output.boundaries),
        boundary_posteriors=where(PLAN.tagged, rules.naert_tables.output.posteriors),
        transitions=where(PLAN.tagged, rules.naert_tables.output.transitions),
        synthesis=where(PLAN.tagged, rules.synthesis.output.synthesis),
        wrist_boundaries=where(PLAN.continuous, rules.one_wrist.output.wrist_boundaries),
        wrist_posteriors=where(PLAN.continuous, rules.one_wrist.output.wrist_posteriors),
        description=lambda w: PLAN.description(w.corpus),
    output:
        pages=directory("<results>/report/recordings/{corpus}"),
        listing="<results>/report/recordings/{corpus}.html",
    log:
        "<logs>/{corpus}/explorer.log",
    params:
        code=PLAN.digest("pages/explorer.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=ExplorerSettings.of(SETTINGS),
    script:
        "../scripts/pages/explorer.py"


rule explorers:
    """Pages of recordings for every corpus."""
    input:
        collect(rules.explorer.output, corpus=PLAN.corpora),
