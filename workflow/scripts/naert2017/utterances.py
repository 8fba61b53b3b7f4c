from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.studies.naert2017.synthesis.utterance import (
        load_database,
        printed_theta,
        utterance_files,
    )

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    base, found = load_database(
        corpus, source.recordings, source.intervals, source.excluded, params.settings
    )
    wanted = params.settings["synthesis"]["utterances"]
    parts = utterance_files(
        corpus,
        Path(params.data),
        base,
        {u["name"]: u["glosses"] for u in wanted if u["corpus"] == corpus.name},
        params.settings,
        printed_theta(source.constants),
        Path(out.folder),
    )
    tables.write_table(parts, out.parts, "utterances", corpus.unit)
    tables.write_table(found, out.found, "found_signs", corpus.unit)
