from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.stages.kinematics import kinematics

    corpus = load_corpus(Path(snakemake.params.corpus))
    recordings = read_recordings(snakemake.input.recordings)
    found = kinematics(corpus, recordings, snakemake.params.settings)
    pd.concat(found.frames).to_parquet(snakemake.output.frames, index=False)
    for name in ("minima", "gaps", "plausibility", "excluded"):
        table = found.table(name, corpus.unit)
        tables.write_table(table, snakemake.output[name], name, corpus.unit)
