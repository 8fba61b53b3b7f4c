from signkin.job import job

with job(snakemake, analysis=True):
    from itertools import chain
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.store import read_recordings
    from signkin.studies.naert2017.interval_chance import interval_chance
    from signkin.studies.naert2017.open_choices import claim_choices, takes_of
    from signkin.studies.naert2017.sampling import sample
    from signkin.studies.naert2017.tagged import kept

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    given = [
        tables.read_table(source[name], name) for name in ("intervals", "transitions", "excluded")
    ]
    used = kept(tables.read_table(source.about, "recordings"), given[2])
    chosen = sample(corpus.name, used, given[0], params.settings.samples.transitions, params.seed)
    given = [chosen.rows(table) for table in given]
    # Read twice: a corpus is more than memory should hold.
    first, again = (
        chain.from_iterable(read_recordings(file, chosen.names) for file in source.recordings)
        for _ in range(2)
    )
    table = claim_choices(corpus, first, *given, params.settings, params.seed, chosen.note)
    tables.write_table(table, out.claim_choices, "claim_choices", corpus.unit)
    takes = takes_of(corpus, again, *given, params.settings)
    draws = params.settings.refinement.draws
    table = chosen.told(interval_chance(corpus.name, takes, draws, params.seed))
    tables.write_table(table, out.interval_chance, "interval_chance")
