from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.endres2013.posteriors import study, write_posteriors
    from signkin.studies.endres2013.single_signs import read_trajectories

    out, settings = snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    trajectories = read_trajectories([snakemake.input.trajectories])
    found = study(corpus, trajectories, settings, snakemake.threads)
    tables.write_table(found.table("binning"), out.binning, "binning")
    tables.write_table(found.table("binning_left_out"), out.left_out, "binning_left_out")
    tables.write_table(found.table("fitted_truths"), out.truths, "fitted_truths")
    write_posteriors(out.posteriors, found.fits)
