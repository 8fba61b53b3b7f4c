from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin.corpus import load_corpus
    from signkin.pages.site import write_site
    from signkin.pages.sources import Sources

    home = Path(snakemake.output.front).parent
    params = snakemake.params
    sources = Sources(
        results=home.parent,
        corpora={name: load_corpus(Path(folder)) for name, folder in params.corpora.items()},
        missing=params.missing,
        paper=Path(snakemake.input.paper[0]).parent,
        endres=Path(snakemake.input.endres).parent,
        settings=params.settings,
        home=home,
        data={name: Path(folder) for name, folder in params.folders.items()},
    )
    write_site(sources, params.commit)
