# Raw files to canonical recordings and tags.


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
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("stages/ingest.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        folder=lambda w: str(PLAN.folders[w.corpus]),
        names=lambda w: PLAN.names(w.corpus, w.shard),
    script:
        "../scripts/stages/ingest.py"
