from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.coarticulation import boundaries

    corpus = load_corpus(Path(snakemake.params.corpus))
    about = tables.read_table(snakemake.input.about, "recordings")
    excluded = tables.read_table(snakemake.input.excluded, "excluded")
    table = boundaries(
        corpus,
        [name for name in about["recording"] if name not in set(excluded["recording"])],
        tables.read_table(snakemake.input.intervals, "intervals"),
        tables.read_table(snakemake.input.minima, "minima"),
        snakemake.params.settings,
    )
    tables.write_table(table, snakemake.output.boundaries, "boundaries", corpus.unit)
