from signkin.job import job

with job(snakemake, analysis=True) as work:
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.exhibits import exhibits, of_groups
    from signkin.figures.style import paper_style
    from signkin.report.drawn import write_figures
    from signkin.studies.endres2013.figures import draw
    from signkin.studies.endres2013.figures.sources import TABLES, read_sources

    source, captions = snakemake.input, Path(snakemake.output.captions)
    corpus = load_corpus(Path(snakemake.params.corpus))
    listing = of_groups(exhibits(Path(source.exhibits).parent), "figures")
    sources = read_sources(
        corpus,
        {name: tables.read_table(source[name], name) for name in TABLES},
        {name: source[name] for name in ("recordings", "trajectories", "posteriors")},
        snakemake.params.settings,
        snakemake.params.seed,
    )
    with paper_style():
        write_figures(draw(sources, listing), listing, captions.parent, captions, corpus.unit, work)
