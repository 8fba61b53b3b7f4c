# Endres, Meirovitch, Flash & Giese 2013: single signs, ground truth, binning, tables and figures.
from signkin.exhibits import exhibits, files, of_groups
from signkin.studies.endres2013.settings import (
    ChoiceSettings,
    CutSettings,
    FitSettings,
    ReadingSettings,
)

# A job of binning has one core: threads that share a Python wait for one another longer than they win.
ENDRES_EXHIBITS = exhibits(PLAN.papers / "endres2013")


rule single_signs:
    """Wrist paths into bins, as recorded and with power-law timing (2.2 to 2.4)."""
    input:
        recordings=rules.ingest.output.recordings,
    output:
        trajectories="<results>/endres2013/{corpus}/shards/{shard}/trajectories.parquet",
        ground_truth="<results>/endres2013/{corpus}/shards/{shard}/ground_truth.csv",
        rejected_draws="<results>/endres2013/{corpus}/shards/{shard}/rejected_draws.csv",
        binning_left_out="<results>/endres2013/{corpus}/shards/{shard}/not_cut.csv",
    log:
        "<logs>/endres2013/{corpus}/{shard}/single_signs.log",
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("endres2013/single_signs.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=CutSettings.of(SETTINGS),
    script:
        "../scripts/endres2013/single_signs.py"


rule bin_single_signs:
    """Bayesian binning with every polynomial order (2.5, 3)."""
    input:
        rules.compile_kernels.output,
        trajectories=rules.single_signs.output.trajectories,
    output:
        binning="<results>/endres2013/{corpus}/shards/{shard}/binning.csv",
        fitted_truths="<results>/endres2013/{corpus}/shards/{shard}/fitted_truths.csv",
        binning_left_out="<results>/endres2013/{corpus}/shards/{shard}/not_binned.csv",
        posteriors="<results>/endres2013/{corpus}/shards/{shard}/posteriors.parquet",
    log:
        "<logs>/endres2013/{corpus}/{shard}/binning.log",
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("endres2013/bin_single_signs.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=FitSettings.of(SETTINGS),
    script:
        "../scripts/endres2013/bin_single_signs.py"


rule endres_tables:
    """Order posteriors, hit rates, chance lines and tests, for a whole corpus (3.1 to 3.3)."""
    input:
        binning=of_shards(rules.bin_single_signs.output.binning),
        fitted_truths=of_shards(rules.bin_single_signs.output.fitted_truths),
        ground_truth=of_shards(rules.single_signs.output.ground_truth),
        rejected_draws=of_shards(rules.single_signs.output.rejected_draws),
        not_cut=of_shards(rules.single_signs.output.binning_left_out),
        not_binned=of_shards(rules.bin_single_signs.output.binning_left_out),
        trajectories=of_shards(rules.single_signs.output.trajectories),
    output:
        binning="<results>/endres2013/{corpus}/binning.csv",
        fitted_truths="<results>/endres2013/{corpus}/fitted_truths.csv",
        ground_truth="<results>/endres2013/{corpus}/ground_truth.csv",
        rejected_draws="<results>/endres2013/{corpus}/rejected_draws.csv",
        binning_left_out="<results>/endres2013/{corpus}/left_out.csv",
        order_posteriors="<results>/endres2013/{corpus}/order_posteriors.csv",
        hit_rates="<results>/endres2013/{corpus}/hit_rates.csv",
        chance_lines="<results>/endres2013/{corpus}/chance_lines.csv",
        order_tests="<results>/endres2013/{corpus}/order_tests.csv",
    log:
        "<logs>/endres2013/{corpus}/tables.log",
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("endres2013/tables.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=SETTINGS.binning,
    script:
        "../scripts/endres2013/tables.py"


rule endres_figures:
    """Figures 1, 3 to 7 and A1, with the numbers drawn in them."""
    input:
        exhibits=PLAN.papers / "endres2013" / "exhibits.yaml",
        recordings=of_shards(rules.ingest.output.recordings),
        trajectories=of_shards(rules.single_signs.output.trajectories),
        posteriors=of_shards(rules.bin_single_signs.output.posteriors),
        ground_truth=rules.endres_tables.output.ground_truth,
        order_posteriors=rules.endres_tables.output.order_posteriors,
        hit_rates=rules.endres_tables.output.hit_rates,
        chance_lines=rules.endres_tables.output.chance_lines,
        order_tests=rules.endres_tables.output.order_tests,
    output:
        files(of_groups(ENDRES_EXHIBITS, "figures"), "<results>/endres2013/{corpus}"),
        captions="<results>/endres2013/{corpus}/captions.json",
    log:
        "<logs>/endres2013/{corpus}/figures.log",
    params:
        code=PLAN.digest("endres2013/figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=CutSettings.of(SETTINGS),
    script:
        "../scripts/endres2013/figures.py"


rule order_choices:
    """What the paper does not print: varied, under two priors, and learnt from the data (3.2)."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        ground_truth=rules.endres_tables.output.ground_truth,
        binning=rules.endres_tables.output.binning,
        trajectories=of_shards(rules.single_signs.output.trajectories),
    output:
        order_choices="<results>/endres2013/{corpus}/order_choices.csv",
        learnt_prior="<results>/endres2013/{corpus}/learnt_prior.csv",
        two_priors="<results>/endres2013/{corpus}/two_priors.csv",
        beside_svg="<results>/endres2013/{corpus}/fig_two_priors.svg",
        beside_pdf="<results>/endres2013/{corpus}/fig_two_priors.pdf",
        beside_caption="<results>/endres2013/{corpus}/two_priors.txt",
        svg="<results>/endres2013/{corpus}/fig_order_choices.svg",
        pdf="<results>/endres2013/{corpus}/fig_order_choices.pdf",
        caption="<results>/endres2013/{corpus}/order_choices.txt",
    log:
        "<logs>/endres2013/{corpus}/order_choices.log",
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("endres2013/open_choices.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=ChoiceSettings.of(SETTINGS),
    script:
        "../scripts/endres2013/open_choices.py"


rule printed_readings:
    """The study without each rule that we add to the print (2.4, 3.1)."""
    input:
        rules.compile_kernels.output,
        recordings=of_shards(rules.ingest.output.recordings),
    output:
        equal_bins="<results>/endres2013/{corpus}/equal_bins.csv",
        readings_binning="<results>/endres2013/{corpus}/readings_binning.csv",
        readings_hit_rates="<results>/endres2013/{corpus}/readings_hit_rates.csv",
        readings_order_posteriors="<results>/endres2013/{corpus}/readings_order_posteriors.csv",
        readings_ground_truth="<results>/endres2013/{corpus}/readings_ground_truth.csv",
    log:
        "<logs>/endres2013/{corpus}/readings.log",
    priority: LONGEST_CHAIN - 1
    params:
        code=PLAN.digest("endres2013/readings.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=ReadingSettings.of(SETTINGS),
    script:
        "../scripts/endres2013/readings.py"


rule recorded_laws:
    """Power laws of recorded segments, and what noise and filter do to exponents (2.3)."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        posteriors=of_shards(rules.bin_single_signs.output.posteriors),
        about=rules.gather.output.recordings,
    output:
        recorded_laws="<results>/endres2013/{corpus}/recorded_laws.csv",
        law_pitfalls="<results>/endres2013/{corpus}/law_pitfalls.csv",
        svg="<results>/endres2013/{corpus}/fig_recorded_laws.svg",
        pdf="<results>/endres2013/{corpus}/fig_recorded_laws.pdf",
        caption="<results>/endres2013/{corpus}/recorded_laws.txt",
    log:
        "<logs>/endres2013/{corpus}/recorded_laws.log",
    params:
        code=PLAN.digest("endres2013/recorded_laws.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=CutSettings.of(SETTINGS),
        recordings=SETTINGS.binning.fitted_recordings,
    script:
        "../scripts/endres2013/recorded_laws.py"


rule binning_scheme:
    """The model as a drawing (Fig. 2)."""
    input:
        exhibits=PLAN.papers / "endres2013" / "exhibits.yaml",
    output:
        files(of_groups(ENDRES_EXHIBITS, "scheme"), "<results>/endres2013"),
        captions="<results>/endres2013/captions.json",
    log:
        "<logs>/endres2013/scheme.log",
    params:
        code=PLAN.digest("endres2013/scheme.py"),
    script:
        "../scripts/endres2013/scheme.py"


rule endres2013:
    """Tables and figures of Endres et al. 2013 for every corpus of single signs."""
    input:
        collect(rules.endres_tables.output, corpus=PLAN.single_signs),
        collect(rules.endres_figures.output, corpus=PLAN.single_signs),
        collect(rules.order_choices.output, corpus=PLAN.single_signs),
        collect(rules.printed_readings.output, corpus=PLAN.single_signs),
        collect(rules.recorded_laws.output, corpus=PLAN.single_signs),
        collect(rules.one_wrist.output, corpus=PLAN.continuous),
        collect(
            rules.gather_binning_elan.output,
            corpus=[c for c in PLAN.tagged if c in PLAN.continuous],
        ),
        rules.binning_scheme.output,
