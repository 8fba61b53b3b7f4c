from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.endres2013.readings import readings

    params = snakemake.params
    corpus = load_corpus(Path(params.corpus))
    found = readings(
        corpus, snakemake.input.recordings, params.settings, params.seed, snakemake.threads
    )
    for name, table in found.items():
        tables.write_table(table, snakemake.output[name], name, corpus.unit)
