"""Tables of the audit."""

from __future__ import annotations

from signkin.tables.schema import NOTE, Column, Table, text

_CLAIM = (
    text("paper", "folder of the paper below papers/"),
    text("id", "claim, as papers/<paper>/claims.yaml names it"),
    text("location", "section, table or figure of the paper"),
    text("evidence", "published numbers, or a corpus"),
    text("evidence_kind", "published numbers, simulated (a test of the method) or real"),
)

TABLES = (
    Table(
        "claims",
        "results/audit/claims.csv",
        "a claim of a paper on one piece of evidence",
        (
            *_CLAIM,
            text("claim", "what is claimed, in our words"),
            text("printed", "the numbers as printed"),
            text("recomputed", "the numbers recomputed"),
            text("interval", "what rounding allows them to be; on a corpus, 95 % by bootstrap"),
            text(
                "verdict",
                "consistent or inconsistent (published numbers); holds, fails, undecided (the data "
                "allow both), depends (on what is not printed) or by construction (made with the "
                "printed number), on corpora; or not testable",
            ),
            text("note", "why, or what is missing"),
            text("as_printed", "the verdict without each rule of ours that adds to the print"),
            text("source", "tables behind it"),
        ),
    ),
    Table(
        "checks",
        "results/audit/checks.csv",
        "a finding of a check",
        (
            *_CLAIM,
            text("check", "check, as the claim names it"),
            text("counts", "yes; or `beside the claim`: told, without a say in its verdict"),
            text("item", "row of the printed table that the finding is about"),
            text("reads", "how the claim is read"),
            text("printed", "as printed"),
            text("recomputed", "recomputed"),
            text(
                "interval",
                "what rounding allows; on a corpus, 95 % by bootstrap, or what chance gives",
            ),
            text(
                "verdict",
                "consistent, inconsistent, undecidable; holds, fails, undecided, depends; not "
                "testable",
            ),
            text("why", "one sentence"),
            text("source", "table behind it"),
        ),
    ),
    Table(
        "specifications",
        "results/audit/curves/<paper>_<claim>_levels.csv",
        "a level of a choice in the specification curve of a claim, or `all`",
        (
            text("paper", "folder of the paper below papers/"),
            text("claim", "claim"),
            text("corpus", "corpus"),
            text("choice", "choice that the paper leaves open, or all"),
            text("level", "its value"),
            Column("specifications", "", "combinations of choices with this level"),
            Column("holding", "", "of these, where the claim holds"),
            Column("share", "", "holding over specifications"),
            Column("median_estimate", "see the curve", "median of the estimates"),
            Column(
                "share_decided",
                "",
                "share of the variance of holds (yes 1, no 0) that lies between the levels of "
                "this choice; the largest decides",
            ),
            NOTE,
        ),
    ),
)
