from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.endres2013.single_signs import single_signs, write_trajectories

    out = snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    recordings = read_recordings(snakemake.input.recordings)
    found = single_signs(corpus, recordings, snakemake.params.settings, snakemake.params.seed)
    write_trajectories(out.trajectories, found.trajectories)
    for name in ("ground_truth", "rejected_draws", "binning_left_out"):
        tables.write_table(found.table(name, corpus.unit), out[name], name, corpus.unit)
