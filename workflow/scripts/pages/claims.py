from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.audit.paper import read_paper
    from signkin.errors import SignkinError
    from signkin.pages.ledger import ledger_of

    out = snakemake.output
    ledger = ledger_of(
        [read_paper(folder) for folder in snakemake.params.papers],
        snakemake.params.corpora,
        [Path(file) for file in snakemake.input],
        Path(out.claims).parents[1],
    )
    for fault in ledger.faults:  # a run does not go on with claims left out
        raise SignkinError(fault)
    tables.write_table(ledger.claims, out.claims, "claims")
    tables.write_table(ledger.checks, out.checks, "checks")
