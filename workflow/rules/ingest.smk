# Raw files to canonical recordings and tags.

for name in PLAN.simulated_by("lsf-sim"):

    rule:
        name:
            f"simulate_{name.replace('-', '_')}"
        input:
            description=PLAN.description(name),
            table2=PLAN.papers / "naert2017" / "table2.csv",
            constants=PLAN.papers / "naert2017" / "constants.csv",
        output:
            data=[
                f"<results>/{name}/simulated/{file}" for file in PLAN.corpora[name].files()
            ],
            truth=f"<results>/{name}/simulated/truth.csv",
            design=f"<results>/{name}/simulated/design.csv",
        log:
            f"<logs>/{name}/simulate.log",
        params:
            code=PLAN.digest("simulate_lsf.py"),
            corpus=str(PLAN.corpora[name].folder),
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
