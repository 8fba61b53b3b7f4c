"""Claims of Naert et al. 2017 under each combination of open choices."""

from __future__ import annotations

from signkin.tables.naert2017 import figures, refinement
from signkin.tables.schema import NOTE, Column, Table, text


def _of(name: str, among: tuple[Table, ...]) -> tuple[Column, ...]:
    return next(table.columns for table in among if table.name == name)


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
            text("null", "what chance is; empty where it plays no part"),
            text("statistic", "what the estimate is"),
            Column("estimate", "see statistic", "the number the claim is about"),
            Column("bound", "see statistic", "what it is set against"),
            Column("low", "see statistic", "below it the claim fails; empty where all else does"),
            Column("holds", "", "whether the claim holds so"),
            Column("n", "", "transitions or tags"),
            NOTE,
        ),
    ),
    Table(
        "interval_chance",
        "results/naert2017/<corpus>/interval_chance.csv",
        "durations and distances of transitions against random intervals of the same durations "
        "(Naert et al. 2017, section 5.1 item 1)",
        (
            text("corpus", "corpus"),
            text("null", "what chance is"),
            text("measure", "Pearson r of duration and mean distance"),
            Column("value", "", "of the transitions"),
            Column("chance", "", "mean over draws of random intervals"),
            Column("chance_low", "", "2.5 % of the draws"),
            Column("chance_high", "", "97.5 % of the draws"),
            Column("p", "", "draws with as high an r, one-sided: (1 + such) / (1 + all)"),
            Column("n", "", "transitions"),
            Column("draws", "", "draws"),
            NOTE,
        ),
    ),
    Table(
        "readings_boundaries",
        "results/naert2017/<corpus>/readings_boundaries.csv",
        "a tag for one hand, refined by the paper's plain rule: each tag to its nearest minimum",
        (text("reading", "which rule"), *_of("boundaries", refinement.TABLES)),
    ),
    Table(
        "readings_segmentations",
        "results/naert2017/<corpus>/readings_segmentations.csv",
        "a transition of one hand with manual tags, and refined by the paper's plain rule",
        (text("reading", "which rule"), *_of("segmentations", figures.TABLES)),
    ),
)
