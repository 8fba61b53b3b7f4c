from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.endres2013.single_signs import POWERLAW, read_trajectories
    from signkin.studies.endres2013.summaries import summaries

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    made = {
        name: tables.concatenated(source[name], name, corpus.unit)
        for name in ("binning", "fitted_truths", "ground_truth", "rejected_draws")
    }
    made["binning_left_out"] = tables.concatenated(
        [*source.not_cut, *source.not_binned], "binning_left_out", corpus.unit
    )
    true = read_trajectories(source.trajectories, dataset=POWERLAW)
    made |= summaries(corpus.name, made, true, params.settings, params.seed)
    for name, table in made.items():
        tables.write_table(table, out[name], name, corpus.unit)
