from signkin.job import job

with job(snakemake) as work:
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import write_recordings
    from signkin.stages.ingest import ingest, refuse_none

    corpus = load_corpus(Path(snakemake.params.corpus))
    wanted = set(snakemake.params.names)
    entries = [entry for entry in corpus.entries if entry.recording in wanted]
    ingested = ingest(corpus, Path(snakemake.params.folder), entries)
    tables.write_table(ingested.table("recordings"), snakemake.output.about, "recordings")
    tables.write_table(ingested.table("intervals"), snakemake.output.intervals, "intervals")
    tables.write_table(ingested.table("excluded"), snakemake.output.excluded, "excluded")
    work.optional = corpus.skips  # what is left of the corpus goes on
    refuse_none(corpus, ingested.excluded, len(ingested.recordings))
    write_recordings(snakemake.output.recordings, ingested.recordings)
