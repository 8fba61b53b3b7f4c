from signkin.job import job

with job(snakemake):
    import pandas as pd

    from signkin import tables
    from signkin.figures.style import paper_style, save
    from signkin.studies.naert2017 import durations_figures, durations_models, durations_surface

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    name, unit, settings = snakemake.wildcards.corpus, params.unit, params.settings
    speeds = tables.concatenated(source.speeds, "transition_speeds", unit)
    constants = pd.read_csv(source.constants, dtype=str, keep_default_na=False)
    printed = dict(zip(constants["name"], constants["value"], strict=True))
    learn = durations_models.learnable(
        tables.read_table(source.transitions, "transitions"), speeds, unit, settings
    )
    models, predictions = durations_models.models(name, learn, settings, printed, params.seed)
    theta = durations_surface.coefficients(name, learn, settings, printed, params.seed)
    tables.write_table(speeds, out.speeds, "transition_speeds", unit)
    tables.write_table(models, out.models, "duration_models")
    tables.write_table(theta, out.coefficients, "duration_coefficients")
    tables.write_table(predictions, out.predictions, "duration_predictions")
    with paper_style():
        save(durations_figures.draw_predictions(predictions), *out.figure)
