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
            Column("plain_s", "s", "time after the paper's plain rule, each tag on its own"),
            Column("moved", "", "whether the tag was moved to a minimum"),
            Column("distance_s", "s", "from the tag to the nearest minimum"),
            text("status", "moved, far (no minimum in the window) or taken (see note)"),
            NOTE,
        ),
    ),
    Table(
        "boundary_posteriors",
        "results/naert2017/<corpus>/boundary_posteriors.csv",
        "a tag for one hand, and where its boundary is, with its uncertainty "
        "(signkin.coarticulation.refine_posterior)",
        (
            *LEAD,
            SIGN,
            text("gloss", "label of the sign"),
            EDGE,
            HAND,
            Column("manual_s", "s", "time of the manual tag"),
            Column("mean_s", "s", "mean of the posterior"),
            Column("low50_s", "s", "25 % quantile"),
            Column("high50_s", "s", "75 % quantile"),
            Column("low90_s", "s", "5 % quantile"),
            Column("high90_s", "s", "95 % quantile"),
            Column("off", "", "probability that the boundary is more than 0.1 s from the tag"),
            Column("own_minimum", "", "probability that a speed minimum is the boundary's own"),
            Column(
                "acts",
                "",
                "whether the hand acts in the sign (by its type); only such tags teach the model",
            ),
            Column("bias_s", "s", "boundary less tag, learnt from the corpus for hand and edge"),
            Column("jitter_s", "s", "SD of the tags about their boundaries, learnt for the hand"),
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
            Column("low", "see unit", "its 95 % interval, tags taken as independent"),
            Column("high", "see unit", "its 95 % interval"),
            text("unit", "its unit"),
            Column("chance", "see unit", "mean over sets of tags placed at random"),
            Column("chance_low", "see unit", "2.5 % quantile over these sets"),
            Column("chance_high", "see unit", "97.5 % quantile"),
            Column("n", "", "tags (or pairs of tags)"),
            NOTE,
        ),
    ),
    Table(
        "tag_chance",
        "results/naert2017/<corpus>/tag_chance.csv",
        "how near the manual tags lie to the speed minima of one hand, against one null "
        "(signkin.statistics.nulls)",
        (
            text("corpus", "corpus"),
            HAND,
            text("tags", "all, or transition (those that bound a transition)"),
            text(
                "null",
                "circular shift, signs and gaps permuted, uniform (all within a stretch of "
                "signing), or Poisson (the line alone)",
            ),
            text(
                "measure",
                "share within the window, mean share (over the windows), median distance, or "
                "median change of duration (of transitions, each tag moved to its nearest minimum)",
            ),
            Column("window_s", "s", "window of the share; empty for the other measures"),
            Column("value", "share or s", "for the manual tags"),
            Column("chance", "share or s", "mean over the draws of the null"),
            Column("chance_low", "share or s", "2.5 % quantile over the draws"),
            Column("chance_high", "share or s", "97.5 % quantile"),
            Column("p", "", "share of draws as near or nearer (one-sided)"),
            Column(
                "p_holm",
                "",
                "for the mean share: p adjusted (Holm) for both hands, both sets of tags and "
                "the three nulls",
            ),
            Column("n", "", "tags; transitions, for the change of duration"),
            Column("stretches", "", "stretches of signing without a long pause"),
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
