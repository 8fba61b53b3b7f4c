from signkin.job import job

with job(snakemake, analysis=True):
    import shutil
    from pathlib import Path

    folder = Path(snakemake.output.folder)
    folder.mkdir(parents=True)
    for source in map(Path, snakemake.input.folders):
        for path in sorted(source.iterdir()):
            shutil.copyfile(path, folder / path.name)
