from signkin.job import job

with job(snakemake):
    import json
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.endres2013 import figures as endres_figures

    source, out = snakemake.input, snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    frames = {
        name: tables.read_table(source[name], name)
        for name in ("ground_truth", "order_posteriors", "hit_rates", "chance_lines", "order_tests")
    }
    with paper_style():
        drawn = endres_figures.draw(
            corpus,
            frames,
            source.recordings,
            source.trajectories,
            source.posteriors,
            snakemake.params.settings,
            snakemake.params.seed,
        )
        names = endres_figures.FIGURES
        for name, svg, pdf, csv in zip(names, out.svg, out.pdf, out.csv, strict=True):
            save(drawn[name].figure, svg, pdf)
            kind = "fig01_powerlaw" if name == "fig01" else "endres_figure"
            tables.write_table(drawn[name].data, csv, kind, corpus.unit)
    captions = {name: figure.caption for name, figure in drawn.items()}
    Path(out.captions).write_text(json.dumps(captions, indent=1) + "\n", encoding="utf-8")
