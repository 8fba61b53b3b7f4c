from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.endres2013.posteriors import study, write_posteriors
    from signkin.studies.endres2013.single_signs import read_trajectories

    out = snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    trajectories = read_trajectories([snakemake.input.trajectories])
    found = study(corpus, trajectories, snakemake.params.settings, snakemake.threads)
    for name in ("binning", "fitted_truths", "binning_left_out"):
        tables.write_table(found.table(name), out[name], name, corpus.unit)
    write_posteriors(out.posteriors, found.fits)
