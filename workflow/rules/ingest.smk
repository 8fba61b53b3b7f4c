# Raw files to canonical recordings and tags.

if PLAN.simulated_by("lsf-sim"):
    LSF_SIM = PLAN.simulated_by("lsf-sim")

    rule simulate_lsf:
        """Signing with known truth, written as BVH and ELAN files."""
        input:
            description=PLAN.description(LSF_SIM),
            table2=PLAN.papers / "naert2017" / "table2.csv",
            constants=PLAN.papers / "naert2017" / "constants.csv",
        output:
            data=collect(
                "<results>/{corpus}/simulated/{file}",
                corpus=LSF_SIM,
                file=PLAN.corpora[LSF_SIM].files(),
            ),
            truth=f"<results>/{LSF_SIM}/simulated/truth.csv",
            design=f"<results>/{LSF_SIM}/simulated/design.csv",
        log:
            f"<logs>/{LSF_SIM}/simulate.log",
        params:
            code=PLAN.digest("simulate_lsf.py"),
            corpus=lambda w: str(PLAN.corpora[LSF_SIM].folder),
            seed=config["seed"],
            euclidean_unit_m=config["transitions"]["euclidean_unit_m"],
        script:
            "../scripts/simulate_lsf.py"


rule ingest:
    """Raw motion and tags to one shape, in metres and seconds."""
    input:
        description=lambda w: PLAN.description(w.corpus),
        data=lambda w: PLAN.files(w.corpus, w.shard),
    output:
        recordings="<results>/{corpus}/recordings/{shard}.parquet",
        about="<results>/{corpus}/shards/{shard}/recordings.csv",
        intervals="<results>/{corpus}/shards/{shard}/intervals.csv",
        excluded="<results>/{corpus}/shards/{shard}/excluded_reading.csv",
    log:
        "<logs>/{corpus}/{shard}/ingest.log",
    params:
        code=PLAN.digest("ingest.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        folder=lambda w: str(PLAN.folders[w.corpus]),
        names=lambda w: PLAN.names(w.corpus, w.shard),
    script:
        "../scripts/ingest.py"
