from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin.exhibits import exhibits, of_groups
    from signkin.figures.style import paper_style
    from signkin.report.drawn import write_figures
    from signkin.studies.endres2013.figures import fig02

    captions = Path(snakemake.output.captions)
    listing = of_groups(exhibits(Path(snakemake.input.exhibits).parent), "scheme")
    with paper_style():
        write_figures({"fig02": fig02.drawn()}, listing, captions.parent, captions, "m")
