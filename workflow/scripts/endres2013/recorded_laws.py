from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.endres2013.figures.recorded_laws import drawn
    from signkin.studies.endres2013.recorded_laws import law_pitfalls, recorded_laws

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    laws = recorded_laws(
        corpus, source.recordings, source.posteriors, params.settings, params.recordings
    )
    rate = tables.read_table(source.about, "recordings")["rate_hz"].median()
    known = law_pitfalls(corpus, float(rate), params.settings, params.seed)
    tables.write_table(laws, out.recorded_laws, "recorded_laws", corpus.unit)
    tables.write_table(known, out.law_pitfalls, "law_pitfalls", corpus.unit)
    with paper_style():
        figure = drawn(laws, known)
        save(figure.figure, out.svg, out.pdf)
    Path(out.caption).write_text(figure.caption + "\n", encoding="utf-8")
