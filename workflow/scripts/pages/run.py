from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin.corpus import load_corpus
    from signkin.pages.run import Sources, make_page
    from signkin.report.page import render

    page_file = Path(snakemake.output.page)
    corpora = {name: load_corpus(Path(f)) for name, f in snakemake.params.corpora.items()}
    sources = Sources(
        results=page_file.parents[1],
        corpora=corpora,
        missing=snakemake.params.missing,
        paper=Path(snakemake.input.paper[0]).parent,
        endres=Path(snakemake.input.endres).parent,
        settings=snakemake.params.settings,
    )
    page_file.write_text(render(make_page(sources), page_file.parent), encoding="utf-8")
