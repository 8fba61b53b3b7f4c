from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.endres2013 import summaries as endres2013
    from signkin.studies.endres2013.single_signs import read_trajectories

    source, out = snakemake.input, snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    gathered = {
        name: tables.concatenated(source[name], name, corpus.unit)
        for name in ("binning", "fitted_truths", "ground_truth", "rejected_draws")
    }
    left_out = tables.concatenated([*source.not_cut, *source.not_binned], "binning_left_out")
    binning = gathered["binning"]
    truths = endres2013.known_boundaries(
        read_trajectories(source.trajectories), gathered["fitted_truths"]
    )
    rates, lines = endres2013.hit_rates(
        corpus.name, binning, truths, snakemake.params.settings, snakemake.params.seed
    )
    for table, name, path in (
        (binning, "binning", out.binning),
        (gathered["fitted_truths"], "fitted_truths", out.truths),
        (gathered["ground_truth"], "ground_truth", out.ground_truth),
        (gathered["rejected_draws"], "rejected_draws", out.rejected),
        (left_out, "binning_left_out", out.left_out),
        (endres2013.order_posteriors(corpus.name, binning), "order_posteriors", out.orders),
        (rates, "hit_rates", out.rates),
        (lines, "chance_lines", out.lines),
        (endres2013.order_tests(corpus.name, binning), "order_tests", out.tests),
    ):
        tables.write_table(table, path, name, corpus.unit)
