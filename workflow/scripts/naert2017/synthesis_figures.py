from signkin.job import job

with job(snakemake):
    import json
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017.synthesis.figures import draw
    from signkin.studies.naert2017.synthesis.utterance import load_database, printed_theta

    source, params = snakemake.input, snakemake.params
    captions = Path(snakemake.output.captions)
    folder = captions.parents[1]
    corpus = load_corpus(Path(params.corpus))
    base, _ = load_database(
        corpus, source.recordings, source.intervals, source.excluded, params.settings
    )
    rows = tables.read_table(source.synthesis, "synthesis") if corpus.tagged else None
    with paper_style():
        drawn = draw(base, rows, params.settings, printed_theta(source.constants))
        for name, figure in drawn.items():
            save(figure.figure, folder / f"{name}.svg", folder / f"{name}.pdf")
            tables.write_table(figure.data, folder / f"{name}.csv", "skeletons", corpus.unit)
    told = {name: figure.caption for name, figure in drawn.items()}
    captions.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
