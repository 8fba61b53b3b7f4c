from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    import pandas as pd

    from signkin import tables
    from signkin.studies.naert2017.elan import refined_copies

    folder = Path(snakemake.output.folder)
    folder.mkdir(parents=True)
    copies = refined_copies(
        Path(snakemake.params.data),
        tables.read_table(snakemake.input.about, "recordings"),
        tables.read_table(snakemake.input.boundaries, "boundaries"),
        tables.read_table(snakemake.input.intervals, "intervals"),
        elan=snakemake.params.elan,
        posteriors=pd.read_parquet(snakemake.input.posteriors),
    )
    for name, content in copies.items():
        (folder / name).write_bytes(content)
