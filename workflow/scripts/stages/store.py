from signkin.job import job

with job(snakemake):
    import shutil
    from pathlib import Path

    # Copies, not links: Snakemake gives its outputs a time of its own, and then takes them away.
    results = Path(snakemake.input[0]).parts[0]
    hidden = shutil.ignore_patterns(".*")
    shutil.copytree(results, snakemake.output[0], dirs_exist_ok=True, ignore=hidden)
