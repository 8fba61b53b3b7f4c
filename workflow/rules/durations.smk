# Naert, Larboulette & Gibet 2017: statistics and models of transition duration.


rule duration_statistics:
    """Do durations differ by type, and with distance? (5.1)"""
    input:
        transitions=rules.naert_tables.output.transitions,
    output:
        statistics="<results>/naert2017/{corpus}/statistics.csv",
    log:
        "<logs>/naert2017/{corpus}/statistics.log",
    params:
        code=PLAN.digest("duration_statistics.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        seed=config["seed"],
        settings={k: config[k] for k in ("transitions", "durations")},
    script:
        "../scripts/duration_statistics.py"


rule duration_models:
    """SIMPLE, BOUNDED, LINEAR and SURFACE against the truth (5.2)."""
    input:
        transitions=rules.naert_tables.output.transitions,
        speeds=lambda w: collect(
            "<results>/naert2017/{corpus}/shards/{shard}/transition_speeds.csv",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        constants=PLAN.papers / "naert2017" / "constants.csv",
    output:
        speeds="<results>/naert2017/{corpus}/transition_speeds.csv",
        models="<results>/naert2017/{corpus}/duration_models.csv",
        coefficients="<results>/naert2017/{corpus}/duration_coefficients.csv",
        predictions="<results>/naert2017/{corpus}/fig_durations.csv",
        figure=multiext("<results>/naert2017/{corpus}/fig_durations", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/duration_models.log",
    params:
        code=PLAN.digest("duration_models.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        seed=config["seed"],
        settings={k: config[k] for k in ("transitions", "durations")},
    script:
        "../scripts/duration_models.py"


rule duration_surface:
    """The surface of duration over both distances (Fig. 11)."""
    input:
        transitions=rules.naert_tables.output.transitions,
        speeds=rules.duration_models.output.speeds,
    output:
        svg="<results>/naert2017/{corpus}/fig11.svg",
        pdf="<results>/naert2017/{corpus}/fig11.pdf",
        csv="<results>/naert2017/{corpus}/fig11.csv",
    log:
        "<logs>/naert2017/{corpus}/duration_surface.log",
    params:
        code=PLAN.digest("duration_surface.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        settings={k: config[k] for k in ("transitions", "durations")},
    script:
        "../scripts/duration_surface.py"


rule naert2017_durations:
    """Everything about durations for every corpus with tags."""
    input:
        collect(rules.duration_statistics.output, corpus=PLAN.tagged),
        collect(rules.duration_models.output, corpus=PLAN.tagged),
        collect(rules.duration_surface.output, corpus=PLAN.oriented),
