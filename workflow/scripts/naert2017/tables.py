from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.coarticulation.transitions import with_normalised
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017.figures.refinement_quality import draw_quality
    from signkin.studies.naert2017.lexicon import lexicon_use
    from signkin.studies.naert2017.posterior_durations import posterior_durations
    from signkin.studies.naert2017.readings import plain_boundaries, plain_segmentations
    from signkin.studies.naert2017.refinement import refinement
    from signkin.studies.naert2017.sampling import sample
    from signkin.studies.naert2017.table2 import table2
    from signkin.studies.naert2017.tag_chance import tag_chance
    from signkin.studies.naert2017.tagged import together
    from signkin.studies.naert2017.transitions import left_out

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    unit = corpus.unit
    boundaries = tables.concatenated(source.boundaries, "boundaries", unit)
    parts = [part for part in map(pd.read_parquet, source.posteriors) if len(part)]
    posteriors = together(parts, "boundary_posteriors", unit)
    sign_types = tables.concatenated(source.sign_types, "sign_types", unit)
    raw = tables.concatenated(source.transitions, "raw_transitions", unit)
    intervals = tables.read_table(source.intervals, "intervals")
    minima = tables.read_table(source.minima, "minima")
    about = tables.read_table(source.about, "recordings")
    published = pd.read_csv(source.published, dtype=str, keep_default_na=False)

    seed = snakemake.params.seed
    chosen = sample(
        corpus.name, boundaries["recording"], intervals, settings.samples.transitions, seed
    )
    moves = with_normalised(raw, unit)
    quality, chance = refinement(
        corpus, about, intervals, minima, boundaries, settings.refinement, seed, chosen
    )
    near = tag_chance(corpus, about, intervals, minima, chosen, settings.refinement, seed)
    durations = posterior_durations(
        corpus.name,
        chosen.rows(moves),
        chosen.rows(posteriors),
        unit,
        settings.transitions.euclidean_unit_m,
        seed,
    )
    made = {
        "boundaries": ("boundaries", boundaries),
        "posteriors": ("boundary_posteriors", posteriors),
        "posterior_durations": ("posterior_durations", chosen.told(durations)),
        "sign_types": ("sign_types", sign_types),
        "transitions": ("transitions", moves),
        "left_out": ("transitions", left_out(moves)),
        "lexicon": ("lexicon", lexicon_use(corpus, sign_types)),
        "table1": ("table1", tables.concatenated(source.table1, "table1", unit)),
        "table2": ("table2", table2(corpus.name, moves, published, settings.transitions)),
        "refinement": ("refinement", quality),
        "tag_chance": ("tag_chance", near),
        "readings_boundaries": (
            "readings_boundaries",
            plain_boundaries(boundaries, settings.refinement),
        ),
        "readings_segmentations": (
            "readings_segmentations",
            plain_segmentations(moves, boundaries, unit),
        ),
    }
    for name, (kind, table) in made.items():
        tables.write_table(table, out[name], kind, unit)
    with paper_style():
        save(draw_quality(boundaries, chance, settings.refinement.search_window_s), *out.quality)
