from signkin.job import job

with job(snakemake):
    import shutil
    from pathlib import Path

    # Copies, not links: Snakemake gives its outputs a time of its own, and then takes them away.
    results, copy = Path(snakemake.input[0]).parts[0], Path(snakemake.output.results)
    hidden = shutil.ignore_patterns(".*")
    shutil.copytree(results, copy, dirs_exist_ok=True, ignore=hidden)
    files = sum(path.is_file() for path in copy.rglob("*"))
    told = f"{files} files copied to {snakemake.params.address}\n"
    Path(snakemake.output.told).write_text(told, encoding="utf-8")
