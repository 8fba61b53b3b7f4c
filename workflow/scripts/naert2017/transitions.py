from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.naert2017.table1 import table1
    from signkin.studies.naert2017.transitions import transitions

    source = snakemake.input
    corpus = load_corpus(Path(snakemake.params.corpus))
    intervals = tables.read_table(source.intervals, "intervals")
    made = transitions(
        corpus,
        read_recordings(source.recordings),
        pd.read_parquet(source.frames),
        intervals,
        tables.read_table(source.boundaries, "boundaries"),
        snakemake.params.settings,
    )
    made["table1"] = table1(corpus, intervals, made["sign_types"])
    for kind, table in made.items():
        tables.write_table(table, snakemake.output[kind], kind, corpus.unit)
