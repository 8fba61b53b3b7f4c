# Naert, Larboulette & Gibet 2017: refinement, transitions, tables and figures.
from signkin.exhibits import exhibits, files, of_groups
from signkin.studies.naert2017.settings import (
    DurationSettings,
    FigureSettings,
    GridSettings,
    SynthesisSettings,
    TableSettings,
    TransitionSettings,
)

NAERT = PLAN.papers / "naert2017"
NAERT_EXHIBITS = exhibits(NAERT)
SYNTHESIS_FIGURES = ("composition", "truth")  # groups of its list
SYNTHESIS = SynthesisSettings.of(SETTINGS)


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
        code=PLAN.digest("naert2017/refine.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=SETTINGS.refinement,
    script:
        "../scripts/naert2017/refine.py"


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
        raw_transitions="<results>/naert2017/{corpus}/shards/{shard}/transitions.csv",
        transition_speeds="<results>/naert2017/{corpus}/shards/{shard}/transition_speeds.csv",
        table1="<results>/naert2017/{corpus}/shards/{shard}/table1.csv",
    log:
        "<logs>/naert2017/{corpus}/{shard}/transitions.log",
    params:
        code=PLAN.digest("naert2017/transitions.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        settings=TransitionSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/transitions.py"


rule tag_model:
    """How manual tags lie about boundaries, learnt from recordings (4.2)."""
    input:
        sign_types=of_shards(rules.transitions.output.sign_types),
        intervals=rules.gather.output.intervals,
        minima=rules.gather.output.minima,
    output:
        model="<results>/naert2017/{corpus}/tag_model.json",
    log:
        "<logs>/naert2017/{corpus}/tag_model.log",
    params:
        code=PLAN.digest("naert2017/tag_model.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=TableSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/tag_model.py"


rule tag_posteriors:
    """Manual tags as posteriors, per hand (4.2)."""
    input:
        model=rules.tag_model.output.model,
        sign_types=rules.transitions.output.sign_types,
        intervals=rules.ingest.output.intervals,
        minima=rules.kinematics.output.minima,
    output:
        posteriors="<results>/naert2017/{corpus}/shards/{shard}/boundary_posteriors.parquet",
    log:
        "<logs>/naert2017/{corpus}/{shard}/tag_posteriors.log",
    params:
        code=PLAN.digest("naert2017/tag_posteriors.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
    script:
        "../scripts/naert2017/tag_posteriors.py"


rule naert_tables:
    """Table 1, Table 2, quality of the refinement, for a whole corpus."""
    input:
        boundaries=of_shards(rules.refine.output.boundaries),
        sign_types=of_shards(rules.transitions.output.sign_types),
        transitions=of_shards(rules.transitions.output.raw_transitions),
        posteriors=of_shards(rules.tag_posteriors.output.posteriors),
        table1=of_shards(rules.transitions.output.table1),
        about=rules.gather.output.recordings,
        intervals=rules.gather.output.intervals,
        minima=rules.gather.output.minima,
        published=NAERT / "table2.csv",
    output:
        boundaries="<results>/naert2017/{corpus}/boundaries.csv",
        posteriors="<results>/naert2017/{corpus}/boundary_posteriors.csv",
        posterior_durations="<results>/naert2017/{corpus}/posterior_durations.csv",
        sign_types="<results>/naert2017/{corpus}/sign_types.csv",
        transitions="<results>/naert2017/{corpus}/transitions.csv",
        lexicon="<results>/naert2017/{corpus}/lexicon.csv",
        left_out="<results>/naert2017/{corpus}/transitions_left_out.csv",
        table1="<results>/naert2017/{corpus}/table1.csv",
        table2="<results>/naert2017/{corpus}/table2.csv",
        refinement="<results>/naert2017/{corpus}/refinement.csv",
        tag_chance="<results>/naert2017/{corpus}/tag_chance.csv",
        readings_boundaries="<results>/naert2017/{corpus}/readings_boundaries.csv",
        readings_segmentations="<results>/naert2017/{corpus}/readings_segmentations.csv",
        quality=multiext("<results>/naert2017/{corpus}/fig_refinement", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/tables.log",
    params:
        code=PLAN.digest("naert2017/tables.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=TableSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/tables.py"


rule naert_figures:
    """Figures 4 to 10, with the numbers drawn in them."""
    input:
        boundaries=rules.naert_tables.output.boundaries,
        posteriors=rules.naert_tables.output.posteriors,
        sign_types=rules.naert_tables.output.sign_types,
        transitions=rules.naert_tables.output.transitions,
        minima=rules.gather.output.minima,
        frames=of_shards(rules.kinematics.output.frames),
        published=NAERT / "table2.csv",
        exhibits=NAERT / "exhibits.yaml",
    output:
        figures=files(
            of_groups(NAERT_EXHIBITS, "figures"), "<results>/naert2017/{corpus}"
        ),
        diamond="<results>/naert2017/{corpus}/diamond.csv",
        posterior=multiext("<results>/naert2017/{corpus}/fig_posterior", ".svg", ".pdf"),
        captions="<results>/naert2017/{corpus}/captions.json",
    log:
        "<logs>/naert2017/{corpus}/figures.log",
    params:
        code=PLAN.digest("naert2017/figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        groups=("figures",),
        seed=SETTINGS.seed,
        settings=FigureSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/figures.py"


rule write_elan:
    """Refined tags written back: the .eaf with tiers added, posteriors too."""
    input:
        boundaries=rules.refine.output.boundaries,
        posteriors=rules.tag_posteriors.output.posteriors,
        about=rules.ingest.output.about,
        intervals=rules.ingest.output.intervals,
        annotation=lambda w: PLAN.annotation_files(w.corpus, w.shard),
    output:
        folder=directory("<results>/naert2017/{corpus}/shards/{shard}/eaf"),
    log:
        "<logs>/naert2017/{corpus}/{shard}/elan.log",
    params:
        code=PLAN.digest("naert2017/elan.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        elan=lambda w: w.corpus in PLAN.with_elan,
        data=lambda w: str(PLAN.folders[w.corpus]),
    script:
        "../scripts/naert2017/elan.py"


rule gather_elan:
    """The .eaf of a whole corpus."""
    input:
        folders=of_shards(rules.write_elan.output.folder),
    output:
        folder=directory("<results>/naert2017/{corpus}/eaf"),
    log:
        "<logs>/naert2017/{corpus}/elan.log",
    params:
        code=PLAN.digest("stages/gather_folders.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
    script:
        "../scripts/stages/gather_folders.py"


rule simulation_check:
    """Simulated corpora only: tags and surface against the known truth."""
    input:
        boundaries=rules.naert_tables.output.boundaries,
        transitions=rules.naert_tables.output.transitions,
        truth="<results>/{corpus}/simulated/truth.csv",
        design="<results>/{corpus}/simulated/design.csv",
        constants=NAERT / "constants.csv",
    output:
        truth_error="<results>/naert2017/{corpus}/truth_error.csv",
        surface="<results>/naert2017/{corpus}/surface.csv",
        figure=multiext("<results>/naert2017/{corpus}/fig_simulation", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/simulation.log",
    params:
        code=PLAN.digest("naert2017/simulation_check.py"),
        seed=SETTINGS.seed,
        settings=TableSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/simulation_check.py"


if PLAN.with_annotators:

    rule annotators:
        """How far the annotators of a corpus agree, before and after refinement."""
        input:
            about=rules.gather.output.recordings,
            intervals=rules.gather.output.intervals,
            minima=rules.gather.output.minima,
            sign_types=rules.naert_tables.output.sign_types,
            files=lambda w: PLAN.annotator_files(w.corpus),
        output:
            annotator_agreement="<results>/naert2017/{corpus}/annotator_agreement.csv",
            annotator_offsets="<results>/naert2017/{corpus}/annotator_offsets.csv",
            annotator_refined="<results>/naert2017/{corpus}/annotator_refined.csv",
        log:
            "<logs>/naert2017/{corpus}/annotators.log",
        params:
            code=PLAN.digest("naert2017/annotators.py"),
            corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
            data=lambda w: str(PLAN.folders[w.corpus]),
            seed=SETTINGS.seed,
            settings=TableSettings.of(SETTINGS),
        script:
            "../scripts/naert2017/annotators.py"


rule naert2017:
    """Tables and figures of Naert et al. 2017 for every corpus with tags."""
    input:
        collect(rules.naert_tables.output, corpus=PLAN.tagged),
        collect(rules.naert_figures.output, corpus=PLAN.tagged),
        collect(rules.gather_elan.output, corpus=PLAN.tagged),
        collect(rules.simulation_check.output, corpus=PLAN.simulated.get("lsf-sim", [])),
        collect(
            rules.annotators.output if PLAN.with_annotators else [],
            corpus=PLAN.with_annotators,
        ),


rule synthesis:
    """Every captured transition made anew by each method (5.2)."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
    output:
        synthesis="<results>/naert2017/{corpus}/synthesis/synthesis.csv",
        synthesis_summary="<results>/naert2017/{corpus}/synthesis/synthesis_summary.csv",
        readings_synthesis="<results>/naert2017/{corpus}/synthesis/readings_synthesis.csv",
    log:
        "<logs>/naert2017/{corpus}/synthesis.log",
    params:
        code=PLAN.digest("naert2017/synthesis.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=SYNTHESIS,
        draws=SETTINGS.refinement.draws,
    script:
        "../scripts/naert2017/synthesis.py"


rule synthesis_figures:
    """Figures 1, 2, 12 and 13, with the numbers drawn in them."""
    input:
        recordings=rules.synthesis.input.recordings,
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
        constants=NAERT / "constants.csv",
        exhibits=NAERT / "exhibits.yaml",
        synthesis=rules.synthesis.output.synthesis,
    output:
        figures=files(
            of_groups(NAERT_EXHIBITS, *SYNTHESIS_FIGURES),
            "<results>/naert2017/{corpus}",
        ),
        captions="<results>/naert2017/{corpus}/synthesis/captions.json",
    log:
        "<logs>/naert2017/{corpus}/synthesis_figures.log",
    params:
        code=PLAN.digest("naert2017/synthesis_figures.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        groups=SYNTHESIS_FIGURES,
        seed=SETTINGS.seed,
        settings=SYNTHESIS,
    script:
        "../scripts/naert2017/synthesis_figures.py"


if PLAN.with_found_signs:

    rule composition_figures:
        """Figures 1, 2 and 13 of a corpus without tags."""
        input:
            recordings=rules.synthesis.input.recordings,
            intervals=rules.gather.output.intervals,
            excluded=rules.gather.output.excluded,
            description=lambda w: PLAN.description(w.corpus),
            constants=NAERT / "constants.csv",
            exhibits=NAERT / "exhibits.yaml",
        output:
            figures=files(
                of_groups(NAERT_EXHIBITS, "composition"),
                "<results>/naert2017/{corpus}",
            ),
            captions="<results>/naert2017/{corpus}/synthesis/captions.json",
        log:
            "<logs>/naert2017/{corpus}/composition_figures.log",
        wildcard_constraints:
            corpus="|".join(PLAN.with_found_signs),
        params:
            code=PLAN.digest("naert2017/synthesis_figures.py"),
            corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
            groups=("composition",),
            seed=SETTINGS.seed,
            settings=SYNTHESIS,
        script:
            "../scripts/naert2017/synthesis_figures.py"

    ruleorder: composition_figures > synthesis_figures


rule utterances:
    """The utterances of config.yaml, as BVH or table, with their parts (3.1)."""
    input:
        recordings=rules.synthesis.input.recordings,
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        description=lambda w: PLAN.description(w.corpus),
        data=lambda w: PLAN.corpora_files(w.corpus),
        constants=NAERT / "constants.csv",
    output:
        folder=directory("<results>/naert2017/{corpus}/synthesis/utterances"),
        utterances="<results>/naert2017/{corpus}/synthesis/utterances.csv",
        found_signs="<results>/naert2017/{corpus}/synthesis/found_signs.csv",
    log:
        "<logs>/naert2017/{corpus}/utterances.log",
    params:
        code=PLAN.digest("naert2017/utterances.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        data=lambda w: str(PLAN.folders[w.corpus]),
        seed=SETTINGS.seed,
        settings=SYNTHESIS,
    script:
        "../scripts/naert2017/utterances.py"


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


rule duration_statistics:
    """Do durations differ by type, and with distance? (5.1)"""
    input:
        transitions=rules.naert_tables.output.transitions,
    output:
        statistics="<results>/naert2017/{corpus}/statistics.csv",
    log:
        "<logs>/naert2017/{corpus}/statistics.log",
    params:
        code=PLAN.digest("naert2017/duration_statistics.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        seed=SETTINGS.seed,
        settings=DurationSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/duration_statistics.py"


rule duration_models:
    """SIMPLE, BOUNDED, LINEAR and SURFACE against the truth (5.2)."""
    input:
        transitions=rules.naert_tables.output.transitions,
        speeds=of_shards(rules.transitions.output.transition_speeds),
        constants=NAERT / "constants.csv",
    output:
        transition_speeds="<results>/naert2017/{corpus}/transition_speeds.csv",
        duration_models="<results>/naert2017/{corpus}/duration_models.csv",
        duration_coefficients="<results>/naert2017/{corpus}/duration_coefficients.csv",
        duration_predictions="<results>/naert2017/{corpus}/fig_durations.csv",
        figure=multiext("<results>/naert2017/{corpus}/fig_durations", ".svg", ".pdf"),
    log:
        "<logs>/naert2017/{corpus}/duration_models.log",
    params:
        code=PLAN.digest("naert2017/duration_models.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        seed=SETTINGS.seed,
        settings=DurationSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/duration_models.py"


rule duration_surface:
    """The surface of duration over both distances (Fig. 11)."""
    input:
        transitions=rules.naert_tables.output.transitions,
        speeds=rules.duration_models.output.transition_speeds,
    output:
        files(of_groups(NAERT_EXHIBITS, "surface"), "<results>/naert2017/{corpus}"),
    log:
        "<logs>/naert2017/{corpus}/duration_surface.log",
    params:
        code=PLAN.digest("naert2017/duration_surface.py"),
        unit=lambda w: PLAN.corpora[w.corpus].unit,
        settings=DurationSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/duration_surface.py"


rule naert2017_durations:
    """Everything about durations for every corpus with tags."""
    input:
        collect(rules.duration_statistics.output, corpus=PLAN.tagged),
        collect(rules.duration_models.output, corpus=PLAN.tagged),
        collect(rules.duration_surface.output, corpus=PLAN.oriented),


rule claim_choices:
    """Claims of Naert et al. under every combination of open choices."""
    input:
        recordings=of_shards(rules.ingest.output.recordings),
        about=rules.gather.output.recordings,
        intervals=rules.gather.output.intervals,
        excluded=rules.gather.output.excluded,
        transitions=rules.naert_tables.output.transitions,
    output:
        claim_choices="<results>/naert2017/{corpus}/claim_choices.csv",
        interval_chance="<results>/naert2017/{corpus}/interval_chance.csv",
    log:
        "<logs>/naert2017/{corpus}/claim_choices.log",
    params:
        code=PLAN.digest("naert2017/open_choices.py"),
        corpus=lambda w: str(PLAN.corpora[w.corpus].folder),
        seed=SETTINGS.seed,
        settings=GridSettings.of(SETTINGS),
    script:
        "../scripts/naert2017/open_choices.py"
