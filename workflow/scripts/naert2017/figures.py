from signkin.job import job

with job(snakemake, analysis=True) as work:
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.exhibits import exhibits, of_groups
    from signkin.figures.style import paper_style, save
    from signkin.report.drawn import write_figures
    from signkin.studies.naert2017.distances import diamond_table
    from signkin.studies.naert2017.figures.of_transitions import Measured, draw
    from signkin.studies.naert2017.figures.tag_posteriors import draw_posteriors

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    listing = of_groups(exhibits(Path(source.exhibits).parent), *params.groups)
    measured = Measured(
        corpus=corpus,
        boundaries=tables.read_table(source.boundaries, "boundaries"),
        sign_types=tables.read_table(source.sign_types, "sign_types"),
        transitions=tables.read_table(source.transitions, "transitions"),
        minima=tables.read_table(source.minima, "minima"),
        frames=[Path(path) for path in source.frames],
        published=pd.read_csv(source.published, dtype=str, keep_default_na=False),
        settings=params.settings,
        seed=params.seed,
    )
    folder = Path(out.captions).parent
    with paper_style():
        write_figures(draw(measured, listing), listing, folder, out.captions, corpus.unit, work)
    with work.part("the diamond's corners", out.diamond):
        corners = diamond_table(corpus.name, measured.transitions, params.settings.transitions)
        tables.write_table(corners, out.diamond, "diamond")
    with work.part("tags and their posteriors", *out.posterior), paper_style():
        excerpt = tables.read_table(folder / "fig06.csv", "excerpt")
        posteriors = tables.read_table(source.posteriors, "boundary_posteriors")
        save(draw_posteriors(excerpt, posteriors, corpus.unit), *out.posterior)
