from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.one_wrist.analysis import events_of, one_wrist
    from signkin.studies.one_wrist.figures import drawn, example_frames
    from signkin.studies.one_wrist.scores import segmentation_scores

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    made = {
        name: tables.concatenated(source[name], name, corpus.unit)
        for name in ("wrist_posteriors", "wrist_boundaries", "binning_left_out")
    }
    about = tables.read_table(source.recordings, "recordings")
    minima = tables.read_table(source.minima, "minima")
    tags = tables.read_table(source.boundaries, "boundaries") if source.boundaries else None
    events = events_of(made["wrist_boundaries"], minima, tags)
    made["one_wrist"], rates = one_wrist(
        corpus, about, made["wrist_posteriors"], events, params.hit_window_s, params.seed
    )
    made["segmentation_scores"] = tables.empty("segmentation_scores")
    if tags is not None:
        posteriors = tables.read_table(source.posteriors, "boundary_posteriors")
        made["segmentation_scores"] = segmentation_scores(
            corpus.name, tags, posteriors, minima, made, params.seed
        )
    frames = example_frames(source.frames, about, made["wrist_posteriors"])
    with paper_style():
        figure = drawn(
            corpus,
            made["one_wrist"],
            rates,
            frames,
            events,
            params.continuous,
            params.hit_window_s,
        )
        save(figure.figure, out.svg, out.pdf)
    made["endres_figure"] = figure.data
    for name, table in made.items():
        tables.write_table(table, out[name], name, corpus.unit)
    Path(out.caption).write_text(figure.caption + "\n", encoding="utf-8")
