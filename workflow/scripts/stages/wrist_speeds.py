from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.figures.style import paper_style, save
    from signkin.pages.speeds import draw_speeds

    minima = tables.read_table(snakemake.input.minima, "minima")
    frames = [Path(path) for path in snakemake.input.frames]
    with paper_style():
        figure = draw_speeds(frames, minima, snakemake.params.unit)
        save(figure, *snakemake.output.figure)
