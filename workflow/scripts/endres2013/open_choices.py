from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.endres2013.figures.open_choices import drawn
    from signkin.studies.endres2013.open_choices import chosen_recordings, order_choices

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    truth = tables.read_table(source.ground_truth, "ground_truth")
    recordings = chosen_recordings(source.recordings, truth, settings.choices.recordings)
    table = order_choices(corpus, recordings, settings, snakemake.params.seed, snakemake.threads)
    tables.write_table(table, out.order_choices, "order_choices", corpus.unit)
    with paper_style():
        figure = drawn(table)
        save(figure.figure, out.svg, out.pdf)
    Path(out.caption).write_text(figure.caption + "\n", encoding="utf-8")
