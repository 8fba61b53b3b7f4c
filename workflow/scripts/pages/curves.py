from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.audit.paper import read_paper
    from signkin.figures.style import paper_style, save
    from signkin.pages.curves import draw_curves
    from signkin.pages.readings import draw_readings

    folder = Path(snakemake.output.folder)
    folder.mkdir(parents=True)
    papers = [read_paper(paper) for paper in snakemake.params.papers]
    files = [Path(file) for file in snakemake.input]
    with paper_style():
        for curve in draw_curves(papers, snakemake.params.corpora, files, folder.parents[1]):
            save(curve.figure, folder / f"{curve.name}.svg", folder / f"{curve.name}.pdf")
            curve.points.to_csv(
                folder / f"{curve.name}.csv", index=False, float_format="%.9g", lineterminator="\n"
            )
            tables.write_table(curve.levels, folder / f"{curve.name}_levels.csv", "specifications")
        for one in draw_readings(papers, snakemake.params.corpora, files, folder.parents[1]):
            save(one.figure, folder / f"{one.name}.svg", folder / f"{one.name}.pdf")
            one.points.to_csv(folder / f"{one.name}.csv", index=False, lineterminator="\n")
