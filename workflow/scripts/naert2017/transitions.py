from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.naert2017.transitions import transitions

    source = snakemake.input
    corpus = load_corpus(Path(snakemake.params.corpus))
    made = transitions(
        corpus,
        read_recordings(source.recordings),
        pd.read_parquet(source.frames),
        tables.read_table(source.intervals, "intervals"),
        tables.read_table(source.boundaries, "boundaries"),
        snakemake.params.settings,
    )
    for kind, table in made.items():
        tables.write_table(table, snakemake.output[kind], kind, corpus.unit)
