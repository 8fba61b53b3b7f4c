from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin.results.gathered import gather_files

    gather_files(map(Path, snakemake.input.folders), Path(snakemake.output.folder))
