from signkin.job import job

with job(snakemake, analysis=True):
    import pandas as pd

    from signkin import tables
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017 import simulation
    from signkin.studies.naert2017.figures.simulation import draw_simulation

    source, out, settings = snakemake.input, snakemake.output, snakemake.params.settings
    name = snakemake.wildcards.corpus
    summary, errors = simulation.truth_error(
        name,
        tables.read_table(source.boundaries, "boundaries"),
        tables.read_table(source.truth, "truth"),
        settings.refinement.draws,
        snakemake.params.seed,
    )
    surface = simulation.surface(
        name,
        tables.read_table(source.transitions, "transitions"),
        tables.read_table(source.design, "design"),
        pd.read_csv(source.constants, dtype=str, keep_default_na=False),
        settings.transitions.euclidean_unit_m,
    )
    for kind, table in {"truth_error": summary, "surface": surface}.items():
        tables.write_table(table, out[kind], kind)
    with paper_style():
        save(draw_simulation(errors, surface), *out.figure)
