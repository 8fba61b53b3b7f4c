from signkin.job import job

with job(snakemake, analysis=True) as work:
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.exhibits import exhibits, of_groups
    from signkin.figures.style import paper_style
    from signkin.report.drawn import write_figures
    from signkin.studies.naert2017.figures.of_synthesis import Synthesised, draw
    from signkin.studies.naert2017.synthesis.database import load_database
    from signkin.studies.naert2017.synthesis.duration_models import printed_theta

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    listing = of_groups(exhibits(Path(source.exhibits).parent), *params.groups)
    base, _, _ = load_database(
        corpus,
        source.recordings,
        source.intervals,
        source.excluded,
        params.settings,
        params.seed,
    )
    made = Synthesised(
        base=base,
        rows=tables.read_table(source.synthesis, "synthesis") if corpus.tagged else None,
        printed=printed_theta(source.constants),
        settings=params.settings,
    )
    folder = Path(out.captions).parents[1]
    with paper_style():
        write_figures(draw(made, listing), listing, folder, out.captions, corpus.unit, work)
