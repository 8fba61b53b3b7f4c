from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.io.store import read_recordings
    from signkin.studies.endres2013 import open_choices as sensitivity
    from signkin.studies.endres2013.posteriors import chosen

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    truth = tables.read_table(source.ground_truth, "ground_truth")
    names = chosen(
        list(dict.fromkeys(truth["recording"])), settings["binning"]["sensitivity"]["recordings"]
    )
    recordings = [r for path in source.recordings for r in read_recordings(Path(path), names)]
    table = sensitivity.sensitivity(
        corpus, recordings, settings, snakemake.params.seed, snakemake.threads
    )
    tables.write_table(table, out.table, "sensitivity", corpus.unit)
    with paper_style():
        save(sensitivity.draw(table), out.svg, out.pdf)
    Path(out.caption).write_text(sensitivity.caption(table) + "\n", encoding="utf-8")
