"""Claims of Naert et al. 2017 under each combination of open choices."""

from __future__ import annotations

from signkin.tables.schema import NOTE, Column, Table, text

TABLES = (
    Table(
        "claim_choices",
        "results/naert2017/<corpus>/claim_choices.csv",
        "a claim under one specification: a combination of choices that the paper leaves open",
        (
            text("corpus", "corpus"),
            text("claim", "claim of Naert et al. 2017"),
            text("segmentation", "manual or refined tags"),
            text("hand", "right, left or both"),
            Column("cutoff_hz", "Hz", "low-pass, half gain; empty where it plays no part"),
            Column("prominence", "", "least depth of a minimum; empty where it plays no part"),
            Column("window_s", "s", "refinement window; empty where it plays no part"),
            text("outliers", "kept or left out; empty where it plays no part"),
            text("statistic", "what the estimate is"),
            Column("estimate", "see statistic", "the number the claim is about"),
            Column("bound", "see statistic", "what it is set against"),
            Column("holds", "", "whether the claim holds so"),
            Column("n", "", "transitions or tags"),
            NOTE,
        ),
    ),
)
