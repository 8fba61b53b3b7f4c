from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.naert2017.coarticulation import transitions

    corpus = load_corpus(Path(snakemake.params.corpus))
    frames = pd.read_parquet(snakemake.input.frames)
    sign_types, rows, speeds = transitions(
        corpus,
        read_recordings(snakemake.input.recordings),
        dict(iter(frames.groupby("recording", sort=False))),
        tables.read_table(snakemake.input.intervals, "intervals"),
        tables.read_table(snakemake.input.boundaries, "boundaries"),
        snakemake.params.settings,
    )
    tables.write_table(sign_types, snakemake.output.sign_types, "sign_types", corpus.unit)
    tables.write_table(rows, snakemake.output.transitions, "raw_transitions", corpus.unit)
    tables.write_table(speeds, snakemake.output.speeds, "transition_speeds", corpus.unit)
