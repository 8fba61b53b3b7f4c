# Endres, Meirovitch, Flash & Giese 2013: single signs, ground truth, binning, tables and figures.


rule compile_kernels:
    """Compiled code of the binning engine, once for all jobs."""
    output:
        touch("<results>/endres2013/kernels.done"),
    log:
        "<logs>/endres2013/kernels.log",
    params:
        code=PLAN.digest("compile_kernels.py"),
    script:
        "../scripts/compile_kernels.py"


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
    params:
        code=PLAN.digest("single_signs.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={
            "kinematics": {"longest_gap_s": config["kinematics"]["longest_gap_s"]},
            "binning": {k: config["binning"][k] for k in ("lowpass", "bins")},
            "powerlaw": config["powerlaw"],
        },
    script:
        "../scripts/single_signs.py"


rule bin_single_signs:
    """Bayesian binning with every polynomial order (2.5, 3)."""
    input:
        rules.compile_kernels.output,
        trajectories=rules.single_signs.output.trajectories,
    output:
        binning="<results>/endres2013/{corpus}/shards/{shard}/binning.csv",
        truths="<results>/endres2013/{corpus}/shards/{shard}/fitted_truths.csv",
        left_out="<results>/endres2013/{corpus}/shards/{shard}/not_binned.csv",
        posteriors="<results>/endres2013/{corpus}/shards/{shard}/posteriors.parquet",
    log:
        "<logs>/endres2013/{corpus}/{shard}/binning.log",
    params:
        code=PLAN.digest("bin_single_signs.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings={
            k: v
            for k, v in config["binning"].items()
            if k not in ("sensitivity", "continuous")
        },
    script:
        "../scripts/bin_single_signs.py"


rule endres_tables:
    """Order posteriors, hit rates, chance lines and tests, for a whole corpus (3.1 to 3.3)."""
    input:
        binning=of_shards(rules.bin_single_signs.output.binning),
        fitted_truths=of_shards(rules.bin_single_signs.output.truths),
        ground_truth=of_shards(rules.single_signs.output.ground_truth),
        rejected_draws=of_shards(rules.single_signs.output.rejected_draws),
        not_cut=of_shards(rules.single_signs.output.binning_left_out),
        not_binned=of_shards(rules.bin_single_signs.output.left_out),
        trajectories=of_shards(rules.single_signs.output.trajectories),
    output:
        binning="<results>/endres2013/{corpus}/binning.csv",
        truths="<results>/endres2013/{corpus}/fitted_truths.csv",
        ground_truth="<results>/endres2013/{corpus}/ground_truth.csv",
        rejected="<results>/endres2013/{corpus}/rejected_draws.csv",
        left_out="<results>/endres2013/{corpus}/left_out.csv",
        orders="<results>/endres2013/{corpus}/order_posteriors.csv",
        rates="<results>/endres2013/{corpus}/hit_rates.csv",
        lines="<results>/endres2013/{corpus}/chance_lines.csv",
        tests="<results>/endres2013/{corpus}/order_tests.csv",
    log:
        "<logs>/endres2013/{corpus}/tables.log",
    params:
        code=PLAN.digest("endres_tables.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={
            k: config["binning"][k]
            for k in ("window_s", "bootstrap_draws", "chance_trajectories")
        },
    script:
        "../scripts/endres_tables.py"


rule endres_figures:
    """Figures 1, 3 to 7 and A1, with the numbers drawn in them."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        trajectories=of_shards(rules.single_signs.output.trajectories),
        posteriors=of_shards(rules.bin_single_signs.output.posteriors),
        ground_truth=rules.endres_tables.output.ground_truth,
        order_posteriors=rules.endres_tables.output.orders,
        hit_rates=rules.endres_tables.output.rates,
        chance_lines=rules.endres_tables.output.lines,
        order_tests=rules.endres_tables.output.tests,
    output:
        svg=collect(
            "<results>/endres2013/{{corpus}}/{figure}.svg",
            figure=["fig01", "fig03", "fig04", "fig05", "fig06", "fig07", "figA1"],
        ),
        pdf=collect(
            "<results>/endres2013/{{corpus}}/{figure}.pdf",
            figure=["fig01", "fig03", "fig04", "fig05", "fig06", "fig07", "figA1"],
        ),
        csv=collect(
            "<results>/endres2013/{{corpus}}/{figure}.csv",
            figure=["fig01", "fig03", "fig04", "fig05", "fig06", "fig07", "figA1"],
        ),
        captions="<results>/endres2013/{corpus}/captions.json",
    log:
        "<logs>/endres2013/{corpus}/figures.log",
    params:
        code=PLAN.digest("endres_figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={
            "kinematics": {"longest_gap_s": config["kinematics"]["longest_gap_s"]},
            "binning": {k: config["binning"][k] for k in ("lowpass", "bins")},
            "powerlaw": config["powerlaw"],
        },
    script:
        "../scripts/endres_figures.py"


rule sensitivity:
    """What the paper does not print, varied: prior and bins (3.2)."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        ground_truth=rules.endres_tables.output.ground_truth,
    output:
        table="<results>/endres2013/{corpus}/sensitivity.csv",
        svg="<results>/endres2013/{corpus}/fig_sensitivity.svg",
        pdf="<results>/endres2013/{corpus}/fig_sensitivity.pdf",
        caption="<results>/endres2013/{corpus}/sensitivity.txt",
    log:
        "<logs>/endres2013/{corpus}/sensitivity.log",
    threads: 2
    params:
        code=PLAN.digest("sensitivity.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={
            "kinematics": {"longest_gap_s": config["kinematics"]["longest_gap_s"]},
            "binning": config["binning"],
            "powerlaw": config["powerlaw"],
        },
    script:
        "../scripts/sensitivity.py"


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
        code=PLAN.digest("long_series.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings={
            "kinematics": {"longest_gap_s": config["kinematics"]["longest_gap_s"]},
            "binning": {
                k: config["binning"][k] for k in ("lowpass", "prior", "continuous")
            },
        },
    script:
        "../scripts/long_series.py"


rule one_wrist:
    """Two papers, one wrist: boundaries by binning against speed minima and tags."""
    input:
        wrist_posteriors=of_shards(rules.long_series.output.wrist_posteriors),
        wrist_boundaries=of_shards(rules.long_series.output.wrist_boundaries),
        binning_left_out=of_shards(rules.long_series.output.binning_left_out),
        about=rules.gather.output.recordings,
        minima=rules.gather.output.minima,
        tags=branch(
            lambda w: w.corpus in PLAN.tagged,
            then=rules.naert_tables.output.boundaries,
            otherwise=[],
        ),
        frames=of_shards(rules.kinematics.output.frames),
    output:
        posteriors="<results>/endres2013/{corpus}/wrist_posteriors.csv",
        boundaries="<results>/endres2013/{corpus}/wrist_boundaries.csv",
        left_out="<results>/endres2013/{corpus}/wrists_left_out.csv",
        table="<results>/endres2013/{corpus}/one_wrist.csv",
        csv="<results>/endres2013/{corpus}/fig_one_wrist.csv",
        svg="<results>/endres2013/{corpus}/fig_one_wrist.svg",
        pdf="<results>/endres2013/{corpus}/fig_one_wrist.pdf",
        caption="<results>/endres2013/{corpus}/one_wrist.txt",
    log:
        "<logs>/endres2013/{corpus}/one_wrist.log",
    params:
        code=PLAN.digest("one_wrist.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=config["seed"],
        settings={k: config["binning"][k] for k in ("window_s", "continuous")},
    script:
        "../scripts/one_wrist.py"


rule binning_elan:
    """Segments by binning in the .eaf, as tiers of their own."""
    input:
        boundaries=rules.one_wrist.output.boundaries,
        about=rules.gather.output.recordings,
        annotation=lambda w: PLAN.annotation_files(w.corpus),
    output:
        folder=directory("<results>/endres2013/{corpus}/eaf"),
    log:
        "<logs>/endres2013/{corpus}/elan.log",
    params:
        code=PLAN.digest("binning_elan.py"),
        data=lambda w: str(PLAN.folders[w.corpus]),
    script:
        "../scripts/binning_elan.py"


rule binning_scheme:
    """The model as a drawing (Fig. 2)."""
    output:
        svg="<results>/endres2013/fig02.svg",
        pdf="<results>/endres2013/fig02.pdf",
        csv="<results>/endres2013/fig02.csv",
    log:
        "<logs>/endres2013/scheme.log",
    params:
        code=PLAN.digest("binning_scheme.py"),
    script:
        "../scripts/binning_scheme.py"


rule endres2013:
    """Tables and figures of Endres et al. 2013 for every corpus of single signs."""
    input:
        collect(rules.endres_tables.output, corpus=PLAN.single_signs),
        collect(rules.endres_figures.output, corpus=PLAN.single_signs),
        collect(rules.sensitivity.output, corpus=PLAN.single_signs),
        collect(rules.one_wrist.output, corpus=PLAN.continuous),
        collect(rules.binning_elan.output, corpus=PLAN.with_elan),
        rules.binning_scheme.output,
