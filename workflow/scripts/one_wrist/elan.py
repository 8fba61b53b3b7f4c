from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin import tables
    from signkin.studies.one_wrist.elan import copies

    folder = Path(snakemake.output.folder)
    folder.mkdir(parents=True)
    made = copies(
        Path(snakemake.params.data),
        tables.read_table(snakemake.input.about, "recordings"),
        tables.read_table(snakemake.input.boundaries, "wrist_boundaries"),
        tables.read_table(snakemake.input.intervals, "intervals"),
        elan=snakemake.params.elan,
    )
    for name, content in made.items():
        (folder / name).write_bytes(content)
