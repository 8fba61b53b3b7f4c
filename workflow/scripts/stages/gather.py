from signkin.job import job

with job(snakemake):
    from signkin import tables

    for name in ("recordings", "intervals", "minima", "gaps", "plausibility", "excluded"):
        table = tables.concatenated(snakemake.input[name], name, snakemake.params.unit)
        tables.write_table(table, snakemake.output[name], name, snakemake.params.unit)
