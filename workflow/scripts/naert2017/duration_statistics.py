from signkin.job import job

with job(snakemake, analysis=True):
    from signkin import tables
    from signkin.studies.naert2017.durations_statistics import statistics

    rows = statistics(
        snakemake.wildcards.corpus,
        tables.read_table(snakemake.input.transitions, "transitions"),
        snakemake.params.unit,
        snakemake.params.settings,
        snakemake.params.seed,
    )
    tables.write_table(rows, snakemake.output.statistics, "statistics")
