from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.figures.style import paper_style, save
    from signkin.studies.one_wrist import long_series

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    corpus = load_corpus(Path(snakemake.params.corpus))
    unit = corpus.unit
    gathered = {
        name: tables.concatenated(source[name], name, unit)
        for name in ("wrist_posteriors", "wrist_boundaries", "binning_left_out")
    }
    posteriors, found = gathered["wrist_posteriors"], gathered["wrist_boundaries"]
    about = tables.read_table(source.about, "recordings")
    minima = tables.read_table(source.minima, "minima")
    tags = tables.read_table(source.tags, "boundaries") if source.get("tags") else None
    events = long_series.events_of(found, minima, tags)
    compared, points = long_series.one_wrist(
        corpus, about, posteriors, events, settings["window_s"], snakemake.params.seed
    )
    for name, path in (
        ("wrist_posteriors", out.posteriors),
        ("wrist_boundaries", out.boundaries),
        ("binning_left_out", out.left_out),
    ):
        tables.write_table(gathered[name], path, name, unit)
    tables.write_table(compared, out.table, "one_wrist")
    tables.write_table(points, out.csv, "endres_figure")
    frames = pd.concat(pd.read_parquet(path) for path in source.frames)
    recording = long_series.example(about, posteriors, set(frames["recording"]))
    frames = frames[frames["recording"] == recording]
    with paper_style():
        save(long_series.draw(corpus, points, frames, events, recording), out.svg, out.pdf)
    text = long_series.caption(compared, recording, settings)
    Path(out.caption).write_text(text + "\n", encoding="utf-8")
