"""Segmentations compared: methods against tags, annotators with one another, and what it moves."""

from __future__ import annotations

from signkin.tables.schema import EDGE, HAND, NOTE, Column, Table, text

_CORPUS = text("corpus", "corpus, as its folder is called")
_SCORE = (
    text("measure", "which score (docs/scoring.md)"),
    text("of", "of which edge, class or tolerance"),
    Column("value", "see unit", "the score"),
    text("unit", "s, or empty for shares and ratios"),
    Column("chance", "see unit", "mean with lengths and gaps in another order, by recording"),
    Column("chance_low", "see unit", "2.5 % quantile of these"),
    Column("chance_high", "see unit", "97.5 % quantile"),
)

TABLES = (
    Table(
        "segmentation_scores",
        "results/endres2013/<corpus>/segmentation_scores.csv",
        "a score of a way of finding boundaries against the manual tags, by hand "
        "(signkin.segments.score_methods)",
        (
            _CORPUS,
            HAND,
            text("method", "refined tags, posterior means, speed minima, or binning by order"),
            *_SCORE,
            Column("recordings", "", "recordings with tags that the method was used on"),
            NOTE,
        ),
    ),
    Table(
        "posterior_durations",
        "results/naert2017/<corpus>/posterior_durations.csv",
        "what a measure of transitions becomes with tags moved, or uncertain, by hand",
        (
            _CORPUS,
            HAND,
            text("measure", "of durations, of a test, or of a duration model"),
            text("unit", "s, or empty"),
            Column("manual", "see unit", "between manual tags"),
            Column("refined", "see unit", "between tags refined by the paper's rule"),
            Column(
                "posterior", "see unit", "mean over draws of all boundaries from their posterior"
            ),
            Column("low", "see unit", "2.5 % quantile over the draws"),
            Column("high", "see unit", "97.5 % quantile"),
            Column("n", "", "transitions"),
            NOTE,
        ),
    ),
    Table(
        "annotator_agreement",
        "results/naert2017/<corpus>/annotator_agreement.csv",
        "a score of one annotator's signs against another's (signkin.segments)",
        (
            _CORPUS,
            text("first", "whose signs are scored"),
            text("second", "against whose"),
            *_SCORE,
            NOTE,
        ),
    ),
    Table(
        "annotator_offsets",
        "results/naert2017/<corpus>/annotator_offsets.csv",
        "how far the tags of one annotator lie from another's, in a group of signs",
        (
            _CORPUS,
            text("first", "one annotator"),
            text("second", "the other, whose tag is subtracted"),
            EDGE,
            text("group", "all, gloss, length, hands (as the sign has), or recording"),
            text("name", "which"),
            Column("n", "", "pairs of tags of signs that overlap"),
            Column("mean_s", "s", "mean of first less second; below 0 the first is earlier"),
            Column("low_s", "s", "lower end of the 95 % interval of the mean"),
            Column("high_s", "s", "upper end"),
            Column("sd_s", "s", "standard deviation"),
            Column("median_absolute_s", "s", "median of the absolute offset"),
            Column("q5_s", "s", "5 % quantile of the offset"),
            Column("q25_s", "s", "25 % quantile"),
            Column("q75_s", "s", "75 % quantile"),
            Column("q95_s", "s", "95 % quantile"),
            text("lead", "who tags this edge earlier, where the interval does not hold 0"),
        ),
    ),
    Table(
        "annotator_refined",
        "results/naert2017/<corpus>/annotator_refined.csv",
        "whether refinement brings two annotators nearer to each other, by hand and edge",
        (
            _CORPUS,
            text("first", "one annotator"),
            text("second", "the other"),
            HAND,
            EDGE,
            text("method", "rule (nearest minimum) or posterior (its mean)"),
            Column("n", "", "pairs of tags"),
            Column("before_s", "s", "mean absolute offset between manual tags"),
            Column("after_s", "s", "the same between refined tags"),
            Column("nearer_s", "s", "before less after"),
            Column("chance", "s", "nearer_s if minima are shifted in time (mean of the draws)"),
            Column("chance_low", "s", "2.5 % quantile over the draws"),
            Column("chance_high", "s", "97.5 % quantile"),
            Column("p", "", "share of draws that come as near or nearer (one-sided)"),
            NOTE,
        ),
    ),
)
