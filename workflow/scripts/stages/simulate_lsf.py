from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import numpy as np
    import pandas as pd

    from signkin import seeds, tables
    from signkin.corpus import load_corpus
    from signkin.simulate import lsf

    corpus = load_corpus(Path(snakemake.params.corpus))
    text = {"dtype": str, "keep_default_na": False}
    constants = pd.read_csv(snakemake.input.constants, **text).set_index("name")["value"]
    simulated = lsf.simulate(
        names=[entry.recording for entry in corpus.entries],
        lexicon=corpus.lexicon,
        table2=pd.read_csv(snakemake.input.table2, **text),
        theta=np.array([float(constants[f"theta_{t}"]) for t in lsf.TERMS]),
        mean_error_s=float(constants["mean_error"]),
        euclidean_unit_m=snakemake.params.euclidean_unit_m,
        rng=seeds.stream(snakemake.params.seed, corpus.name),
    )
    folder = Path(snakemake.output.truth).parent
    for entry, recording in zip(corpus.entries, simulated.recordings, strict=True):
        lsf.write_motion(recording, folder / entry.motion)
        lsf.write_tags(recording, folder / entry.annotation)
        rng = seeds.stream(snakemake.params.seed, corpus.name, "second tagger", recording.name)
        for annotator in corpus.annotators:
            path = folder / corpus.annotator_file(entry, annotator)
            lsf.write_second_tags(recording, path, rng)
    tables.write_table(simulated.truth, snakemake.output.truth, "truth")
    tables.write_table(simulated.design, snakemake.output.design, "design")
