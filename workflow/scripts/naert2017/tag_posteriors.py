from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.posteriors import boundary_posteriors, models_of

    source, out = snakemake.input, snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    types = tables.read_table(source.sign_types, "sign_types")
    table = boundary_posteriors(
        corpus,
        dict.fromkeys(types["recording"]),
        tables.read_table(source.intervals, "intervals"),
        tables.read_table(source.minima, "minima"),
        types,
        models_of(Path(source.model).read_text(encoding="utf-8")),
    )
    tables.write_table(table, out.posteriors, "boundary_posteriors", corpus.unit)
