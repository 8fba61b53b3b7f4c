# Two papers, one wrist: long series by Bayesian binning beside speed minima and tags.
from signkin.studies.one_wrist.settings import SeriesSettings


rule long_series:
    """Wrists of continuous recordings as long series, with a longest segment."""
    input:
        rules.compile_kernels.output,
        recordings=rules.ingest.output.recordings,
    output:
        wrist_posteriors="<results>/endres2013/{corpus}/shards/{shard}/wrist_posteriors.csv",
        wrist_boundaries="<results>/endres2013/{corpus}/shards/{shard}/wrist_boundaries.csv",
        binning_left_out="<results>/endres2013/{corpus}/shards/{shard}/wrists_left_out.csv",
    log:
        "<logs>/endres2013/{corpus}/{shard}/long_series.log",
    threads: 2
    params:
        code=PLAN.digest("one_wrist/long_series.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=SeriesSettings.of(SETTINGS),
    script:
        "../scripts/one_wrist/long_series.py"


rule one_wrist:
    """Two papers, one wrist: boundaries by binning against speed minima and tags."""
    input:
        wrist_posteriors=of_shards(rules.long_series.output.wrist_posteriors),
        wrist_boundaries=of_shards(rules.long_series.output.wrist_boundaries),
        binning_left_out=of_shards(rules.long_series.output.binning_left_out),
        recordings=rules.gather.output.recordings,
        minima=rules.gather.output.minima,
        boundaries=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.boundaries,
            otherwise=[],
        ),
        posteriors=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.posteriors,
            otherwise=[],
        ),
        frames=of_shards(rules.kinematics.output.frames),
    output:
        wrist_posteriors="<results>/endres2013/{corpus}/wrist_posteriors.csv",
        wrist_boundaries="<results>/endres2013/{corpus}/wrist_boundaries.csv",
        binning_left_out="<results>/endres2013/{corpus}/wrists_left_out.csv",
        one_wrist="<results>/endres2013/{corpus}/one_wrist.csv",
        segmentation_scores="<results>/endres2013/{corpus}/segmentation_scores.csv",
        endres_figure="<results>/endres2013/{corpus}/fig_one_wrist.csv",
        svg="<results>/endres2013/{corpus}/fig_one_wrist.svg",
        pdf="<results>/endres2013/{corpus}/fig_one_wrist.pdf",
        caption="<results>/endres2013/{corpus}/one_wrist.txt",
    log:
        "<logs>/endres2013/{corpus}/one_wrist.log",
    priority: 1  # claims, curves and pages wait for it
    params:
        code=PLAN.digest("one_wrist/analysis.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        samples=SETTINGS.samples,
        hit_window_s=SETTINGS.binning.hit_window_s,
        continuous=SETTINGS.binning.continuous,
    script:
        "../scripts/one_wrist/analysis.py"


rule binning_elan:
    """Segments by binning in the .eaf, as tiers of their own."""
    input:
        boundaries=rules.long_series.output.wrist_boundaries,
        about=rules.ingest.output.about,
        intervals=rules.ingest.output.intervals,
        annotation=lambda w: PLAN.annotation_files(w.corpus, w.shard),
    output:
        folder=directory("<results>/endres2013/{corpus}/shards/{shard}/eaf"),
    log:
        "<logs>/endres2013/{corpus}/{shard}/elan.log",
    params:
        code=PLAN.digest("one_wrist/elan.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        elan=lambda w: w.corpus in PLAN.with_elan,
        data=lambda w: str(PLAN.folders[w.corpus]),
    script:
        "../scripts/one_wrist/elan.py"


rule gather_binning_elan:
    """The .eaf with segments by binning, of a whole corpus."""
    input:
        folders=of_shards(rules.binning_elan.output.folder),
    output:
        folder=directory("<results>/endres2013/{corpus}/eaf"),
    log:
        "<logs>/endres2013/{corpus}/elan.log",
    params:
        code=PLAN.digest("stages/gather_folders.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
    script:
        "../scripts/stages/gather_folders.py"
