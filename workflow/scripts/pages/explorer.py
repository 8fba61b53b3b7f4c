from signkin.job import job

with job(snakemake, analysis=True):
    from pathlib import Path

    from signkin.corpus import load_corpus
    from signkin.explorer.pages import write_pages
    from signkin.explorer.sources import read_sources

    source, out, params = snakemake.input, snakemake.output, snakemake.params
    corpus = load_corpus(Path(params.corpus))
    sources = read_sources(corpus, params.settings, dict(source.items()))
    write_pages(sources, Path(out.pages), Path(out.listing))
