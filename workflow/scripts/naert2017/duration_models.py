from signkin.job import job

with job(snakemake, analysis=True):
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
    made = {
        "transition_speeds": speeds,
        "duration_models": models,
        "duration_coefficients": durations_surface.coefficients(
            name, learn, settings, printed, params.seed
        ),
        "duration_predictions": predictions,
    }
    for kind, table in made.items():
        tables.write_table(table, out[kind], kind, unit)
    with paper_style():
        save(durations_figures.draw_predictions(predictions), *out.figure)
