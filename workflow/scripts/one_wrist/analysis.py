from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017.sampling import sample, signs_of
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
    every = about["recording"].astype(str)
    chosen = sample(corpus.name, every, signs_of(about), params.samples.transitions, params.seed)
    minima, wrists = chosen.rows(minima), chosen.rows(made["wrist_posteriors"])
    tags = None if tags is None else chosen.rows(tags)
    bounds = chosen.rows(made["wrist_boundaries"])
    events = events_of(bounds, minima, tags)
    compared, rates = one_wrist(corpus, about, wrists, events, params.hit_window_s, params.seed)
    made["one_wrist"] = chosen.told(compared)
    made["segmentation_scores"] = tables.empty("segmentation_scores")
    if tags is not None:
        posteriors = tables.read_table(source.posteriors, "boundary_posteriors")
        binned = {"wrist_posteriors": wrists, "wrist_boundaries": bounds}
        scores = segmentation_scores(
            corpus.name, tags, chosen.rows(posteriors), minima, binned, params.seed
        )
        made["segmentation_scores"] = chosen.told(scores)
    frames = example_frames(source.frames, about, wrists)
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
    caption = f"{figure.caption} These are {chosen.note}." if chosen.note else figure.caption
    Path(out.caption).write_text(caption + "\n", encoding="utf-8")
