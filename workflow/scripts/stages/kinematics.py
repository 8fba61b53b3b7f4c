from signkin.job import job

with job(snakemake) as work:
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.stages.ingest import refuse_none
    from signkin.stages.kinematics import kinematics

    corpus = load_corpus(Path(snakemake.params.corpus))
    work.optional = corpus.skips
    recordings = read_recordings(snakemake.input.recordings)
    found = kinematics(corpus, recordings, snakemake.params.settings)
    for name in ("minima", "gaps", "plausibility", "excluded"):
        table = found.table(name, corpus.unit)
        tables.write_table(table, snakemake.output[name], name, corpus.unit)
    refuse_none(corpus, found.excluded, len(found.frames))
    pd.concat(found.frames).to_parquet(snakemake.output.frames, index=False)
