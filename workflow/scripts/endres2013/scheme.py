from signkin.job import job

with job(snakemake):
    from signkin import tables
    from signkin.figures.style import paper_style, save
    from signkin.studies.endres2013.figures import fig02

    out = snakemake.output
    with paper_style():
        figure, points = fig02()
        save(figure, out.svg, out.pdf)
    tables.write_table(points, out.csv, "endres_figure")
