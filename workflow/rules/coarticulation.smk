# Naert, Larboulette & Gibet 2017: refinement, transitions, tables and figures.


rule refine:
    """Manual tags moved to speed minima, per hand (4.2)."""
    input:
        intervals=rules.ingest.output.intervals,
        about=rules.ingest.output.about,
        minima=rules.kinematics.output.minima,
        excluded=rules.kinematics.output.excluded,
    output:
        boundaries="<results>/naert2017/{corpus}/shards/{shard}/boundaries.csv",
    log:
        "<logs>/naert2017/{corpus}/{shard}/refine.log",
    params:
        code=PLAN.digest("refine.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=config["refinement"],
    script:
        "../scripts/refine.py"


rule transitions:
    """Durations, posture distances and four-digit types (5.1)."""
    input:
        recordings=rules.ingest.output.recordings,
        frames=rules.kinematics.output.frames,
        intervals=rules.ingest.output.intervals,
        boundaries=rules.refine.output.boundaries,
        description=lambda w: PLAN.description(w.corpus),
    output:
        sign_types="<results>/naert2017/{corpus}/shards/{shard}/sign_types.csv",
        transitions="<results>/naert2017/{corpus}/shards/{shard}/transitions.csv",
        speeds="<results>/naert2017/{corpus}/shards/{shard}/transition_speeds.csv",
    log:
        "<logs>/naert2017/{corpus}/{shard}/transitions.log",
    params:
        code=PLAN.digest("transitions.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings={k: config[k] for k in ("kinematics", "transitions", "sign_types")},
    script:
        "../scripts/transitions.py"


rule naert_tables:
    """Table 1, Table 2, quality of the refinement, for a whole corpus."""
    input:
        boundaries=lambda w: collect(
            "<results>/naert2017/{corpus}/shards/{shard}/boundaries.csv",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        sign_types=lambda w: collect(
            "<results>/naert2017/{corpus}/shards/{shard}/sign_types.csv",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        transitions=lambda w: collect(
            "<results>/naert2017/{corpus}/shards/{shard}/transitions.csv",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        about=rules.gather.output.recordings,
        intervals=rules.gather.output.intervals,
        minima=rules.gather.output.minima,
        published=PLAN.papers / "naert2017" / "table2.csv",
    output:
        boundaries="<results>/naert2017/{corpus}/boundaries.csv",
        sign_types="<results>/naert2017/{corpus}/sign_types.csv",
        transitions="<results>/naert2017/{corpus}/transitions.csv",
        lexicon="<results>/naert2017/{corpus}/lexicon.csv",
        left_out="<results>/naert2017/{corpus}/transitions_left_out.csv",
        table1="<results>/naert2017/{corpus}/table1.csv",
        table2="<results>/naert2017/{corpus}/table2.csv",
        refinement="<results>/naert2017/{corpus}/refinement.csv",
        quality=multiext("<results>/naert2017/{corpus}/fig_refinement", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/tables.log",
    params:
        code=PLAN.digest("naert_tables.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={k: config[k] for k in ("refinement", "transitions")},
    script:
        "../scripts/naert_tables.py"


rule naert_figures:
    """Figures 4 to 10, with the numbers drawn in them."""
    input:
        boundaries=rules.naert_tables.output.boundaries,
        sign_types=rules.naert_tables.output.sign_types,
        transitions=rules.naert_tables.output.transitions,
        minima=rules.gather.output.minima,
        frames=lambda w: collect(
            "<results>/{corpus}/kinematics/{shard}.parquet",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        published=PLAN.papers / "naert2017" / "table2.csv",
    output:
        svg=collect(
            "<results>/naert2017/{{corpus}}/{figure}.svg",
            figure=[f"fig{n:02d}" for n in range(4, 11)],
        ),
        pdf=collect(
            "<results>/naert2017/{{corpus}}/{figure}.pdf",
            figure=[f"fig{n:02d}" for n in range(4, 11)],
        ),
        csv=collect(
            "<results>/naert2017/{{corpus}}/{figure}.csv",
            figure=[f"fig{n:02d}" for n in range(4, 11)],
        ),
        diamond="<results>/naert2017/{corpus}/diamond.csv",
        captions="<results>/naert2017/{corpus}/captions.json",
    log:
        "<logs>/naert2017/{corpus}/figures.log",
    params:
        code=PLAN.digest("naert_figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings={k: config[k] for k in ("kinematics", "transitions")},
    script:
        "../scripts/naert_figures.py"


rule write_elan:
    """Refined tags written back: the .eaf with two tiers added."""
    input:
        boundaries=rules.naert_tables.output.boundaries,
        about=rules.gather.output.recordings,
        annotation=lambda w: PLAN.annotation_files(w.corpus),
    output:
        folder=directory("<results>/naert2017/{corpus}/eaf"),
    log:
        "<logs>/naert2017/{corpus}/elan.log",
    params:
        code=PLAN.digest("write_elan.py"),
        data=lambda w: str(PLAN.folders[w.corpus]),
    script:
        "../scripts/write_elan.py"


rule simulation_check:
    """Simulated corpora only: tags and surface against the known truth."""
    input:
        boundaries=rules.naert_tables.output.boundaries,
        transitions=rules.naert_tables.output.transitions,
        truth="<results>/{corpus}/simulated/truth.csv",
        design="<results>/{corpus}/simulated/design.csv",
        constants=PLAN.papers / "naert2017" / "constants.csv",
    output:
        truth_error="<results>/naert2017/{corpus}/truth_error.csv",
        surface="<results>/naert2017/{corpus}/surface.csv",
        figure=multiext("<results>/naert2017/{corpus}/fig_simulation", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/simulation.log",
    params:
        code=PLAN.digest("simulation_check.py"),
        seed=config["seed"],
        settings={k: config[k] for k in ("refinement", "transitions")},
    script:
        "../scripts/simulation_check.py"


rule naert2017:
    """Tables and figures of Naert et al. 2017 for every corpus with tags."""
    input:
        collect(rules.naert_tables.output, corpus=PLAN.tagged),
        collect(rules.naert_figures.output, corpus=PLAN.tagged),
        collect(rules.write_elan.output, corpus=PLAN.with_elan),
        collect(rules.simulation_check.output, corpus=PLAN.simulated.get("lsf-sim", [])),
