# A page a recording: speeds, tags, boundaries, and a skeleton that plays in time with them.
from signkin.explorer.sources import ExplorerSettings


rule explorer:
    """Recordings to look at, a page each."""
    input:
        rules.compile_kernels.output,
        recordings_of=of_shards(rules.ingest.output.recordings),
        frames=of_shards(rules.kinematics.output.frames),
        posteriors=branch(
            lambda w: w.corpus in PLAN.single_signs,
            then=of_shards(rules.bin_single_signs.output.posteriors),
            otherwise=[],
        ),
        recordings=rules.gather.output.recordings,
        intervals=rules.gather.output.intervals,
        minima=rules.gather.output.minima,
        plausibility=rules.gather.output.plausibility,
        excluded=rules.gather.output.excluded,
        boundaries=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.boundaries,
            otherwise=[],
        ),
        boundary_posteriors=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.posteriors,
            otherwise=[],
        ),
        transitions=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.transitions,
            otherwise=[],
        ),
        synthesis=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.synthesis.output.synthesis,
            otherwise=[],
        ),
        wrist_boundaries=branch(
            lambda w: w.corpus in PLAN.continuous,
            then=rules.one_wrist.output.wrist_boundaries,
            otherwise=[],
        ),
        wrist_posteriors=branch(
            lambda w: w.corpus in PLAN.continuous,
            then=rules.one_wrist.output.wrist_posteriors,
            otherwise=[],
        ),
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
