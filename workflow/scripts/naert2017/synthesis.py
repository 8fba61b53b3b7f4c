from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.synthesis.comparison import comparison, summary
    from signkin.studies.naert2017.synthesis.utterance import load_database

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    base, _ = load_database(
        corpus, source.recordings, source.intervals, source.excluded, params.settings
    )
    rows = comparison(base, params.settings)
    tables.write_table(rows, out.synthesis, "synthesis", corpus.unit)
    errors = summary(rows, corpus, params.draws, params.seed)
    tables.write_table(errors, out.summary, "synthesis_summary", corpus.unit)
