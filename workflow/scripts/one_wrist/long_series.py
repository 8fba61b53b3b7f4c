from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.one_wrist.long_series import long_series

    out = snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    recordings = read_recordings(snakemake.input.recordings)
    found = long_series(corpus, recordings, snakemake.params.settings, snakemake.threads)
    for name in ("wrist_posteriors", "wrist_boundaries", "binning_left_out"):
        tables.write_table(found.table(name, corpus.unit), out[name], name, corpus.unit)
