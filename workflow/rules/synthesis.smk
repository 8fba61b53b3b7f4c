# Naert, Larboulette & Gibet 2017, sections 3.1 and 5.2: synthetic transitions and utterances.

SYNTHESIS = {
    k: config[k] for k in ("kinematics", "transitions", "durations", "synthesis")
}


rule synthesis:
    """Every captured transition made anew by each method (5.2)."""
    input:
        recordings=lambda w: collect(
            "<results>/{corpus}/recordings/{shard}.parquet",
            corpus=w.corpus,
            shard=PLAN.shards(w.corpus),
        ),
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
    output:
        synthesis="<results>/naert2017/{corpus}/synthesis/synthesis.csv",
        summary="<results>/naert2017/{corpus}/synthesis/synthesis_summary.csv",
    log:
        "<logs>/naert2017/{corpus}/synthesis.log",
    params:
        code=PLAN.digest("synthesis.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings=SYNTHESIS,
        draws=config["refinement"]["draws"],
    script:
        "../scripts/synthesis.py"


rule synthesis_figures:
    """Figures 1, 2, 12 and 13, with the numbers drawn in them."""
    input:
        recordings=rules.synthesis.input.recordings,
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
        constants=PLAN.papers / "naert2017" / "constants.csv",
        synthesis=rules.synthesis.output.synthesis,
    output:
        multiext(
            "<results>/naert2017/{corpus}/fig",
            *[
                f"{n}.{s}"
                for n in ("01", "02", "12", "13")
                for s in ("svg", "pdf", "csv")
            ],
        ),
        captions="<results>/naert2017/{corpus}/synthesis/captions.json",
    log:
        "<logs>/naert2017/{corpus}/synthesis_figures.log",
    params:
        code=PLAN.digest("synthesis_figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=SYNTHESIS,
    script:
        "../scripts/synthesis_figures.py"


if PLAN.with_found_signs:

    rule composition_figures:
        """Figures 1, 2 and 13 of a corpus without tags."""
        input:
            recordings=lambda w: collect(
                "<results>/{corpus}/recordings/{shard}.parquet",
                corpus=w.corpus,
                shard=PLAN.shards(w.corpus),
            ),
            intervals=rules.gather.output.intervals,
            excluded=rules.gather.output.excluded,
            description=lambda w: PLAN.description(w.corpus),
            constants=PLAN.papers / "naert2017" / "constants.csv",
        output:
            multiext(
                "<results>/naert2017/{corpus}/fig",
                *[
                    f"{n}.{s}"
                    for n in ("01", "02", "13")
                    for s in ("svg", "pdf", "csv")
                ],
            ),
            captions="<results>/naert2017/{corpus}/synthesis/captions.json",
        log:
            "<logs>/naert2017/{corpus}/composition_figures.log",
        wildcard_constraints:
            corpus="|".join(PLAN.with_found_signs),
        params:
            code=PLAN.digest("synthesis_figures.py"),
            corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
            settings=SYNTHESIS,
        script:
            "../scripts/synthesis_figures.py"

    ruleorder: composition_figures > synthesis_figures


rule utterances:
    """The utterances of config.yaml, as BVH or table, with their parts (3.1)."""
    input:
        recordings=rules.synthesis.input.recordings,
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
        data=lambda w: PLAN.corpora_files(w.corpus),
        constants=PLAN.papers / "naert2017" / "constants.csv",
    output:
        folder=directory("<results>/naert2017/{corpus}/synthesis/utterances"),
        parts="<results>/naert2017/{corpus}/synthesis/utterances.csv",
        found="<results>/naert2017/{corpus}/synthesis/found_signs.csv",
    log:
        "<logs>/naert2017/{corpus}/utterances.log",
    params:
        code=PLAN.digest("utterances.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        data=lambda w: str(PLAN.folders[w.corpus]),
        settings=SYNTHESIS,
    script:
        "../scripts/utterances.py"


rule syntheses:
    """Synthesis for every corpus with tags, or with takes of one sign."""
    input:
        collect(rules.synthesis.output, corpus=PLAN.tagged),
        collect(rules.synthesis_figures.output, corpus=PLAN.tagged),
        collect(
            rules.composition_figures.output if PLAN.with_found_signs else [],
            corpus=PLAN.with_found_signs,
        ),
        collect(rules.utterances.output, corpus=PLAN.tagged + PLAN.with_found_signs),
