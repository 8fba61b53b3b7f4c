from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.refinement import boundaries
    from signkin.studies.naert2017.tagged import kept

    source = snakemake.input
    corpus = load_corpus(Path(snakemake.params.corpus))
    table = boundaries(
        corpus,
        kept(
            tables.read_table(source.about, "recordings"),
            tables.read_table(source.excluded, "excluded"),
        ),
        tables.read_table(source.intervals, "intervals"),
        tables.read_table(source.minima, "minima"),
        snakemake.params.settings,
    )
    tables.write_table(table, snakemake.output.boundaries, "boundaries", corpus.unit)
