"""Tables that the report's pages are made of: for the owner of a corpus, and what was read."""

from __future__ import annotations

from signkin.tables.schema import HAND, LEAD, NOTE, Column, Table, text

TABLES = (
    Table(
        "corpus_durations",
        "results/report/corpora/<corpus>_durations.csv",
        "a group of transitions between manual tags",
        (
            text("corpus", "corpus, as its folder is called"),
            text("group", "all, types from, type, signer or recording"),
            text("name", "which: lexicon, motion or untyped; four digits; signer; recording"),
            text("types_from", "where the types of the group come from: lexicon, motion or none"),
            Column("n", "", "transitions"),
            Column("mean_s", "s", "mean duration"),
            Column("low_s", "s", "lower end of the 95 % interval of the mean"),
            Column("high_s", "s", "upper end"),
            Column("sd_s", "s", "standard deviation, divisor n - 1"),
            Column("median_s", "s", "median duration"),
            Column("p5_s", "s", "5 % quantile"),
            Column("p95_s", "s", "95 % quantile"),
            Column("recordings", "", "recordings with such a transition"),
            NOTE,
        ),
    ),
    Table(
        "corpus_tags",
        "results/report/corpora/<corpus>_tags.csv",
        "a hand's tags, of all recordings, a signer's or a recording's",
        (
            text("corpus", "corpus, as its folder is called"),
            text("group", "all, signer or recording"),
            text("name", "which signer or recording"),
            HAND,
            Column("n", "", "tags (starts and ends of signs)"),
            Column("near", "share", "tags with a minimum of that hand's speed within the window"),
            Column("low", "share", "lower end of the 95 % interval (Wilson)"),
            Column("high", "share", "upper end"),
            Column("moved", "share", "tags that refinement moved to a minimum of their own"),
            Column("median_distance_s", "s", "median distance to the nearest minimum"),
        ),
    ),
    Table(
        "corpus_overview",
        "results/report/corpora/<corpus>_recordings.csv",
        "a recording, with what was measured in it and what looks odd",
        (
            *LEAD,
            Column("rate_hz", "Hz", "frames a second"),
            Column("duration_s", "s", "frames / rate"),
            Column("gap_share", "share", "positions missing, of all joints and frames"),
            Column("longest_gap_s", "s", "longest gap of a joint"),
            Column("signs", "", "tagged signs"),
            Column("transitions", "", "transitions between manual tags"),
            Column("mean_s", "s", "mean duration of its transitions"),
            Column("low_s", "s", "lower end of the 95 % interval of the mean"),
            Column("high_s", "s", "upper end"),
            Column("near", "share", "tags near a minimum of speed, of the hand that has more"),
            Column("flags", "", "how many things look odd"),
            text("odd", "what looks odd"),
        ),
    ),
    Table(
        "corpus_todo",
        "results/report/corpora/<corpus>_todo.csv",
        "something to look at",
        (
            *LEAD,
            text("what", "recording, tag, transition or gloss"),
            Column(
                "rank", "", "1: results may be wrong; 2: look; 3: if there is time; 4: rated ok"
            ),
            Column("start_s", "s", "from where in the recording; empty for the whole of it"),
            Column("end_s", "s", "to where"),
            text("gloss", "gloss of the sign, or those of the transition"),
            text("why", "what looks odd"),
        ),
    ),
    Table(
        "data_files",
        "results/report/data_files.csv",
        "a file that the run read",
        (
            text("corpus", "corpus, as its folder is called"),
            text("file", "in the data folder; description/: in the corpus's own folder"),
            Column("bytes", "", "size"),
            text("sha256", "SHA-256 of its content"),
        ),
    ),
)
