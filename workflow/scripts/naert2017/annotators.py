from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.agreement import agreement

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    made = agreement(
        corpus,
        Path(params.data),
        tables.read_table(source.about, "recordings"),
        tables.read_table(source.intervals, "intervals"),
        tables.read_table(source.minima, "minima"),
        tables.read_table(source.sign_types, "sign_types"),
        params.settings.refinement.search_window_s,
        params.seed,
        params.settings.samples.transitions,
    )
    for name, table in made.items():
        tables.write_table(table, out[name], name)
