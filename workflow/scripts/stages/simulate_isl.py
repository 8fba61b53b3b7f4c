from signkin.job import job

with job(snakemake):
    from pathlib import Path

    from signkin import tables
    from signkin.corpus import load_corpus
    from signkin.io.wide_csv import write_wide_csv
    from signkin.simulate import isl

    corpus = load_corpus(Path(snakemake.params.corpus))
    params = snakemake.params
    recipe = isl.Recipe(**dict(params.recipe))
    takes = isl.simulate(corpus.entries, corpus.name, corpus.noise_sd, params.seed, recipe)
    folder = Path(snakemake.output.strokes).parent
    for entry, take in zip(corpus.entries, takes, strict=True):
        write_wide_csv(folder / entry.motion, isl.motion_columns(take), corpus.noise_sd)
    tables.write_table(isl.stroke_table(takes), snakemake.output.strokes, "strokes")
    tables.write_table(isl.path_table(takes), snakemake.output.true_path, "true_path")
