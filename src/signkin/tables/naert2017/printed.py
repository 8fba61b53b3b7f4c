"""Tables 1 and 2 of Naert et al. 2017."""

from __future__ import annotations

from signkin.tables.schema import LEAD, NOTE, Column, Table, text

TABLES = (
    Table(
        "table1",
        "results/naert2017/<corpus>/table1.csv",
        "an utterance (Naert et al. 2017, Table 1)",
        (
            *LEAD,
            text("utterance", "utterance"),
            Column("start_s", "s", "start"),
            Column("end_s", "s", "end"),
            Column("signs", "", "number of signs"),
            text("glosses", "the signs in order"),
            text("translation", "translation, where the corpus has one"),
        ),
    ),
    Table(
        "table2",
        "results/naert2017/<corpus>/table2.csv",
        "a transition type (Naert et al. 2017, Table 2), or `all`",
        (
            text("corpus", "corpus"),
            text("type", "four digits, or all"),
            Column("n", "", "transitions"),
            Column("mean_s", "s", "mean duration"),
            Column("sd_s", "s", "standard deviation, divisor n - 1"),
            Column("n_without_outlier", "", "transitions that are no outliers"),
            Column("mean_without_outlier_s", "s", "their mean"),
            Column("sd_without_outlier_s", "s", "their standard deviation"),
            text("printed_n", "number as the paper would print it; (without outliers)"),
            text("printed_mean", "mean so printed, rounded half up"),
            text("printed_sd", "standard deviation so printed"),
            text("published_n", "number in Naert et al. 2017, Table 2"),
            text("published_mean", "mean there"),
            text("published_sd", "standard deviation there"),
            text("equal", "yes or no: whether printed and published agree in every digit"),
            NOTE,
        ),
    ),
)
