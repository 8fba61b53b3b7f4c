from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.posteriors import models_text, tag_models
    from signkin.studies.naert2017.sampling import sample

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    types = tables.concatenated(source.sign_types, "sign_types", corpus.unit)
    intervals = tables.read_table(source.intervals, "intervals")
    chosen = sample(
        corpus.name,
        types["recording"],
        intervals,
        params.settings.samples.transitions,
        params.seed,
    )
    models = tag_models(
        corpus,
        chosen.names,
        intervals,
        tables.read_table(source.minima, "minima"),
        types,
    )
    Path(out.model).write_text(models_text(models), encoding="utf-8")
