from signkin.job import job

with job(snakemake):
    import json
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017 import exhibits as naert2017

    source, out = snakemake.input, snakemake.output
    corpus = load_corpus(Path(snakemake.params.corpus))
    transitions = tables.read_table(source.transitions, "transitions")
    with paper_style():
        drawn = naert2017.draw(
            corpus,
            transitions,
            tables.read_table(source.boundaries, "boundaries"),
            tables.read_table(source.sign_types, "sign_types"),
            tables.read_table(source.minima, "minima"),
            [Path(path) for path in source.frames],
            pd.read_csv(source.published, dtype=str, keep_default_na=False),
            snakemake.params.settings,
        )
        for name, svg, pdf, csv in zip(naert2017.FIGURES, out.svg, out.pdf, out.csv, strict=True):
            save(drawn[name].figure, svg, pdf)
            kind = naert2017.FIGURE_TABLES[name]
            tables.write_table(drawn[name].data, csv, kind, corpus.unit)
    corners = naert2017.diamond_table(
        corpus.name, transitions, snakemake.params.settings["transitions"]
    )
    tables.write_table(corners, out.diamond, "diamond")
    captions = {name: figure.caption for name, figure in drawn.items()}
    Path(out.captions).write_text(json.dumps(captions, indent=1) + "\n", encoding="utf-8")
