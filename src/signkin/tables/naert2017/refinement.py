"""Tags and their refinement (Naert et al. 2017, section 4)."""

from __future__ import annotations

from signkin.tables.schema import EDGE, HAND, LEAD, NOTE, SIGN, Column, Table, text

TABLES = (
    Table(
        "boundaries",
        "results/naert2017/<corpus>/boundaries.csv",
        "a tag (an edge of a sign) for one hand, before and after refinement "
        "(Naert et al. 2017, section 4.2)",
        (
            *LEAD,
            SIGN,
            text("gloss", "label of the sign"),
            EDGE,
            Column("manual_s", "s", "time of the manual tag"),
            HAND,
            Column("minimum_s", "s", "speed minimum of this hand nearest to the tag"),
            Column("refined_s", "s", "time after refinement"),
            Column("moved", "", "whether the tag was moved to a minimum"),
            Column("distance_s", "s", "from the tag to the nearest minimum"),
            text("status", "moved, far (no minimum in the window) or taken (see note)"),
            NOTE,
        ),
    ),
    Table(
        "refinement",
        "results/naert2017/<corpus>/refinement.csv",
        "a measure of how the tags lie to the speed minima, per hand, against chance",
        (
            text("corpus", "corpus"),
            HAND,
            text("measure", "what is measured"),
            Column("value", "see unit", "for the manual tags"),
            text("unit", "its unit"),
            Column("chance", "see unit", "mean over sets of tags placed at random"),
            Column("chance_low", "see unit", "2.5 % quantile over these sets"),
            Column("chance_high", "see unit", "97.5 % quantile"),
            Column("n", "", "tags (or pairs of tags)"),
            NOTE,
        ),
    ),
    Table(
        "truth_error",
        "results/naert2017/<corpus>/truth_error.csv",
        "the error of the tags of one hand to the known truth (simulated corpora)",
        (
            text("corpus", "corpus"),
            HAND,
            text("segmentation", "manual or refined"),
            Column("n", "", "tags with a known truth"),
            Column("mean_error_s", "s", "mean absolute error"),
            Column("low_s", "s", "2.5 % bootstrap quantile of the mean"),
            Column("high_s", "s", "97.5 % bootstrap quantile"),
            Column("median_error_s", "s", "median absolute error"),
            Column("within_20ms", "", "share of tags within 0.02 s of the truth"),
        ),
    ),
)
