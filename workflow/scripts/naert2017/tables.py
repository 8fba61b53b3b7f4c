from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.coarticulation.transitions import with_normalised
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017 import coarticulation
    from signkin.studies.naert2017 import exhibits as naert2017

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    unit = corpus.unit
    boundaries = tables.concatenated(source.boundaries, "boundaries", unit)
    sign_types = tables.concatenated(source.sign_types, "sign_types", unit)
    raw = tables.concatenated(source.transitions, "raw_transitions", unit)
    intervals = tables.read_table(source.intervals, "intervals")
    minima = tables.read_table(source.minima, "minima")
    published = pd.read_csv(source.published, dtype=str, keep_default_na=False)

    moves = with_normalised(raw, unit)
    lexicon = coarticulation.lexicon_use(corpus, sign_types)
    table1 = coarticulation.table1(corpus, intervals, sign_types)
    table2 = naert2017.table2(corpus.name, moves, published, settings["transitions"])
    refinement, chance = coarticulation.refinement(
        corpus,
        tables.read_table(source.about, "recordings"),
        intervals,
        minima,
        boundaries,
        settings["refinement"],
        snakemake.params.seed,
    )
    for table, name, path in (
        (boundaries, "boundaries", out.boundaries),
        (sign_types, "sign_types", out.sign_types),
        (moves, "transitions", out.transitions),
        (naert2017.left_out(moves), "transitions", out.left_out),
        (lexicon, "lexicon", out.lexicon),
        (table1, "table1", out.table1),
        (table2, "table2", out.table2),
        (refinement, "refinement", out.refinement),
    ):
        tables.write_table(table, path, name, unit)
    with paper_style():
        window_s = settings["refinement"]["window_s"]
        save(naert2017.draw_quality(boundaries, chance, window_s), *out.quality)
