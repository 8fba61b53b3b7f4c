from signkin.job import job

with job(snakemake):
    from pathlib import Path
    from shutil import copyfile

    from signkin import tables
    from signkin.audit.paper import read_paper
    from signkin.pages.audit import audit_page
    from signkin.report.images import InPlace
    from signkin.report.page import render

    page_file = Path(snakemake.output.page)
    for file in map(Path, snakemake.input.papers):
        copy = Path(snakemake.output.printed) / file.parent.name / file.name
        copy.parent.mkdir(parents=True, exist_ok=True)
        copyfile(file, copy)
    page = audit_page(
        [read_paper(folder) for folder in snakemake.params.papers],
        tables.read_table(snakemake.input.claims, "claims"),
        tables.read_table(snakemake.input.checks, "checks"),
        {Path(file).parent.name: Path(file) for file in snakemake.input.wrists},
        page_file.parent,
    )
    page_file.write_text(render(page, page_file.parent, InPlace()), encoding="utf-8")
