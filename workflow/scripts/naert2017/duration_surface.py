from signkin.job import job

with job(snakemake, analysis=True):
    from signkin import tables
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017 import durations_figures, durations_models, durations_surface

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    unit = params.unit
    learn = durations_models.learnable(
        tables.read_table(source.transitions, "transitions"),
        tables.read_table(source.speeds, "transition_speeds"),
        unit,
        params.settings,
    )
    points, theta, _ = durations_surface.surface_points(learn)
    svg, pdf, csv = out
    tables.write_table(points, csv, "surface_points")
    with paper_style():
        save(durations_figures.draw_surface(points, theta, learn.unit_in_words), svg, pdf)
