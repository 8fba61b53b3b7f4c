"""The numbers drawn in the figures of Naert et al. 2017, the models' aside."""

from __future__ import annotations

from signkin.tables.schema import HAND, LEAD, Column, Table, text

TABLES = (
    Table(
        "excerpt",
        "results/naert2017/<corpus>/fig04.csv, fig05.csv, fig06.csv",
        "a point of a speed figure (Naert et al. 2017, Fig. 4-6)",
        (
            text("corpus", "corpus"),
            text("recording", "recording the excerpt is taken from"),
            text("kind", "speed, tag, minimum or refined"),
            text("hand", "right or left; both for tags"),
            text("edge", "start or end of a sign, for tags and refined tags"),
            text("gloss", "sign the tag belongs to"),
            text("status", "moved, far or taken, for refined tags (see boundaries)"),
            Column("time_s", "s", "time in the recording"),
            Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed of the wrist"),
        ),
    ),
    Table(
        "distances",
        "results/naert2017/<corpus>/fig07.csv, fig08.csv",
        "a transition between manual tags, overlapping signs left out (Fig. 7, 8)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            text("type", "four digits"),
            Column("mean_distance", "", "average of the two normalised distances"),
            Column("duration_s", "s", "duration"),
            Column("outlier", "", "whether the outlier rule marks it"),
            Column("in_diamond", "", "whether the diamond of Fig. 8 holds it"),
        ),
    ),
    Table(
        "diamond",
        "results/naert2017/<corpus>/diamond.csv",
        "a corner of the diamond of Fig. 8",
        (
            text("corpus", "corpus"),
            text("corner", "left, top, right or bottom"),
            Column("mean_distance", "", "average normalised distance at the corner"),
            Column("duration_s", "s", "duration at the corner"),
            Column("share_inside", "", "share of the transitions that the diamond holds"),
            Column("n", "", "transitions"),
        ),
    ),
    Table(
        "segmentations",
        "results/naert2017/<corpus>/fig09.csv",
        "a transition of one hand with manual and with refined tags (Fig. 9)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            HAND,
            Column("manual_euclidean_{u}", "m or px", "distance of the arm's joints"),
            Column("manual_duration_s", "s", "duration between manual tags"),
            Column("refined_euclidean_{u}", "m or px", "distance, refined tags"),
            Column("refined_duration_s", "s", "duration between refined tags"),
        ),
    ),
    Table(
        "fig10",
        "results/naert2017/<corpus>/fig10.csv",
        "a change in the number of hands, or one transition (Naert et al. 2017, Fig. 10; type 2 is "
        "two-handed)",
        (
            text("corpus", "corpus"),
            text("kind", "mean (a bar) or transition (a dot)"),
            text("change", "1H to 1H, 1H to 2H, 2H to 1H or 2H to 2H"),
            Column("duration_s", "s", "of one transition; empty in means"),
            Column("n", "", "transitions; empty in single ones"),
            Column("mean_s", "s", "mean duration"),
            Column("sd_s", "s", "standard deviation, divisor n - 1"),
            Column("published_n", "", "transitions, summed from the paper's Table 2"),
            Column("published_mean_s", "s", "mean that follows from the paper's Table 2"),
        ),
    ),
    Table(
        "skeletons",
        "results/naert2017/<corpus>/fig01.csv, fig02.csv, fig12.csv, fig13.csv",
        "a joint of a drawn posture, or a point of a drawn speed curve",
        (
            text("corpus", "corpus"),
            text("panel", "which part of the figure"),
            text("motion", "what is drawn: captured, or method and duration"),
            text("kind", "joint, speed, or duration of a model"),
            text("joint", "joint, or the hand of a speed"),
            Column("time_s", "s", "time from the start of the transition; the duration itself"),
            Column("x_{u}", "m or px", "position, to the signer's right"),
            Column("y_{u}", "m or px", "position, forward"),
            Column("z_{u}", "m or px", "position, up"),
            Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed of the wrist"),
        ),
    ),
    Table(
        "overview",
        "results/naert2017/fig03.csv",
        "a rule of the workflow (the counterpart of Naert et al. 2017, Fig. 3)",
        (
            text("rule", "rule"),
            text("stage", "file in workflow/rules it stands in"),
            text("note", "what it does"),
            Column("column", "", "place from left to right among the rules of its stage"),
            Column("row", "", "place from top to bottom; a stage has rows of its own"),
            text("after", "rules whose output it takes, those behind others left out"),
        ),
    ),
)
