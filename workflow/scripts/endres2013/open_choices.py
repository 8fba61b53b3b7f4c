from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.endres2013.figures import two_priors as beside
    from signkin.studies.endres2013.figures.open_choices import drawn
    from signkin.studies.endres2013.learnt import learnt_priors
    from signkin.studies.endres2013.open_choices import chosen_recordings, order_choices
    from signkin.studies.endres2013.single_signs import read_trajectories
    from signkin.studies.endres2013.two_priors import two_priors

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    truth = tables.read_table(source.ground_truth, "ground_truth")
    recordings = chosen_recordings(source.recordings, truth, settings.choices.recordings)
    table = order_choices(corpus, recordings, settings, snakemake.params.seed, snakemake.threads)
    tables.write_table(table, out.order_choices, "order_choices", corpus.unit)
    cut = read_trajectories(source.trajectories)
    binning = tables.read_table(source.binning, "binning")
    both = two_priors(corpus, cut, binning, settings, snakemake.threads)
    tables.write_table(both, out.two_priors, "two_priors", corpus.unit)
    learnt = learnt_priors(corpus, cut, settings, snakemake.threads)
    tables.write_table(learnt, out.learnt_prior, "learnt_prior", corpus.unit)
    with paper_style():
        for figure, svg, pdf, caption in (
            (drawn(table), out.svg, out.pdf, out.caption),
            (beside.drawn(corpus.name, both), out.beside_svg, out.beside_pdf, out.beside_caption),
        ):
            save(figure.figure, svg, pdf)
            Path(caption).write_text(figure.caption + "\n", encoding="utf-8")
