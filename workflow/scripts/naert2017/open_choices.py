from signkin.job import job

with job(snakemake, analysis=True):
    from itertools import chain
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.naert2017.open_choices import claim_choices

    source = snakemake.input
    corpus = load_corpus(Path(snakemake.params.corpus))
    table = claim_choices(
        corpus,
        chain.from_iterable(read_recordings(path) for path in source.recordings),
        tables.read_table(source.intervals, "intervals"),
        tables.read_table(source.transitions, "transitions"),
        tables.read_table(source.excluded, "excluded"),
        snakemake.params.settings,
        snakemake.params.seed,
    )
    tables.write_table(table, snakemake.output.claim_choices, "claim_choices", corpus.unit)
