from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.synthesis.database import load_database
    from signkin.studies.naert2017.synthesis.duration_models import printed_theta
    from signkin.studies.naert2017.synthesis.utterance_files import utterance_files, wanted_of

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    wanted = wanted_of(corpus.name, params.settings.synthesis.utterances)
    base, found, _ = load_database(
        corpus,
        source.recordings,
        source.intervals,
        source.excluded,
        params.settings,
        params.seed,
        [gloss for glosses in wanted.values() for gloss in glosses],
    )
    parts = utterance_files(
        corpus,
        Path(params.data),
        base,
        wanted,
        params.settings,
        printed_theta(source.constants),
        Path(out.folder),
    )
    for kind, table in {"utterances": parts, "found_signs": found}.items():
        tables.write_table(table, out[kind], kind, corpus.unit)
