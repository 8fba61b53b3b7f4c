from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.synthesis.comparison import comparison
    from signkin.studies.naert2017.synthesis.database import load_database
    from signkin.studies.naert2017.synthesis.readings import synthesis_readings
    from signkin.studies.naert2017.synthesis.summary import summary

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    base, _, chosen = load_database(
        corpus,
        source.recordings,
        source.intervals,
        source.excluded,
        params.settings,
        params.seed,
    )
    rows = comparison(base, params.settings)
    errors = summary(rows, corpus, params.draws, params.seed)
    printed = synthesis_readings(base, params.settings, params.seed)
    for kind, table in {
        "synthesis": rows,
        "synthesis_summary": chosen.told(errors),
        "readings_synthesis": chosen.told(printed),
    }.items():
        tables.write_table(table, out[kind], kind, corpus.unit)
