# Canonical recordings to wrist paths, speeds and minima.


rule kinematics:
    """Low-pass, wrist speed and its minima; gaps and plausibility (4.1)."""
    input:
        recordings=rules.ingest.output.recordings,
    output:
        frames="<results>/{corpus}/kinematics/{shard}.parquet",
        minima="<results>/{corpus}/shards/{shard}/minima.csv",
        gaps="<results>/{corpus}/shards/{shard}/gaps.csv",
        plausibility="<results>/{corpus}/shards/{shard}/plausibility.csv",
        excluded="<results>/{corpus}/shards/{shard}/excluded_wrists.csv",
    log:
        "<logs>/{corpus}/{shard}/kinematics.log",
    params:
        code=PLAN.digest("stages/kinematics.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=SETTINGS.kinematics,
    script:
        "../scripts/stages/kinematics.py"


rule gather:
    """The tables of a corpus that both studies share."""
    input:
        recordings=of_shards(rules.ingest.output.about),
        intervals=of_shards(rules.ingest.output.intervals),
        minima=of_shards(rules.kinematics.output.minima),
        gaps=of_shards(rules.kinematics.output.gaps),
        plausibility=of_shards(rules.kinematics.output.plausibility),
        excluded=of_shards(
            rules.ingest.output.excluded, rules.kinematics.output.excluded
        ),
    output:
        recordings="<results>/{corpus}/recordings.csv",
        intervals="<results>/{corpus}/intervals.csv",
        minima="<results>/{corpus}/minima.csv",
        gaps="<results>/{corpus}/gaps.csv",
        plausibility="<results>/{corpus}/plausibility.csv",
        excluded="<results>/{corpus}/excluded.csv",
    log:
        "<logs>/{corpus}/gather.log",
    params:
        code=PLAN.digest("stages/gather.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
    script:
        "../scripts/stages/gather.py"


rule wrist_speeds:
    """Speed curves of a corpus without tags."""
    input:
        frames=of_shards(rules.kinematics.output.frames),
        minima=rules.gather.output.minima,
    output:
        figure=multiext("<results>/{corpus}/fig_speed", ".svg", ".pdf"),
    log:
        "<logs>/{corpus}/wrist_speeds.log",
    params:
        code=PLAN.digest("stages/wrist_speeds.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
    script:
        "../scripts/stages/wrist_speeds.py"
