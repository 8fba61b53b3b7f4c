"""Synthetic transitions and utterances (Naert et al. 2017, sections 3.1 and 5.2)."""

from __future__ import annotations

from signkin.tables.schema import LEAD, NOTE, Column, Table, text

TABLES = (
    Table(
        "synthesis",
        "results/naert2017/<corpus>/synthesis/synthesis.csv",
        "a captured transition made anew by one method with one duration "
        "(Naert et al. 2017, sections 3.1 and 5.2)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            text("previous_gloss", "sign before"),
            text("next_gloss", "sign after"),
            text(
                "material",
                "own: the two signs themselves; other: other signs of the same two glosses, "
                "so that the captured transition is not seen",
            ),
            text("method", "interpolation or blending"),
            text(
                "duration_model",
                "simple, simple_bounded, linear, surface (fitted without this recording, or "
                "without this transition where there is one recording), or true",
            ),
            Column("true_s", "s", "captured duration, between manual tags"),
            Column("duration_s", "s", "duration by the model"),
            Column("duration_error_s", "s", "model - captured"),
            Column(
                "error_{u}",
                "m or px",
                "mean joint distance to the captured motion, time aligned",
            ),
            Column("wrist_error_{u}", "m or px", "the same, both wrists alone"),
            Column("peak_speed_{u}_per_s", "m/s or px/s", "fastest wrist, low-passed"),
            Column("true_peak_speed_{u}_per_s", "m/s or px/s", "the same, captured"),
            Column(
                "rms_jerk_{u}_per_s3",
                "m/s3 or px/s3",
                "root mean square jerk of both wrists, low-passed",
            ),
            Column("true_rms_jerk_{u}_per_s3", "m/s3 or px/s3", "the same, captured"),
            Column("minima", "", "speed minima of both wrists within the transition"),
            Column("true_minima", "", "the same, captured"),
            Column("extra_minima", "", "minima - true_minima: hesitations where above 0"),
            Column("overrun_s", "s", "blending: how far it reaches into another sign"),
            Column("idle_frames", "", "frames without captured motion: idle posture"),
            NOTE,
        ),
    ),
    Table(
        "synthesis_summary",
        "results/naert2017/<corpus>/synthesis/synthesis_summary.csv",
        "an error of one method with one duration, over the transitions that all methods "
        "have a value for; the smaller, the nearer to real signing",
        (
            text("corpus", "corpus"),
            text("material", "own or other (see synthesis)"),
            text("measure", "which error"),
            text("unit", "its unit; |ln ratio|: none"),
            text("method", "interpolation or blending; either, where it does not matter"),
            text("duration_model", "simple, simple_bounded, linear, surface or true"),
            Column("transitions", "", "transitions made"),
            Column("n", "", "of these, with a value for every method"),
            Column("mean", "see unit", "mean error"),
            Column("low", "see unit", "2.5 % bootstrap quantile (transitions resampled)"),
            Column("high", "see unit", "97.5 % bootstrap quantile"),
            Column("over_best", "see unit", "mean error over that of the nearest method"),
            Column("over_best_low", "see unit", "2.5 % bootstrap quantile, paired"),
            Column("over_best_high", "see unit", "97.5 % bootstrap quantile, paired"),
            text(
                "nearest",
                "nearest (least mean error), as near (the interval of over_best holds 0), "
                "farther, or reference (true duration)",
            ),
            NOTE,
        ),
    ),
    Table(
        "readings_synthesis",
        "results/naert2017/<corpus>/synthesis/readings_synthesis.csv",
        "a number of synthesis with a rule of ours, or as printed",
        (
            text("corpus", "corpus"),
            text("rule", "orientations or retrieval (config.yaml, synthesis)"),
            text("reading", "how: slerp or linear, chain or greedy"),
            text("printed", "yes where it is as printed"),
            text("claims", "claims that rest on it"),
            text("method", "interpolation, of captured transitions in their true time"),
            text("measure", "which error, or distance"),
            text("unit", "its unit; |ln ratio|: none"),
            Column("n", "", "transitions, or lists of five glosses"),
            Column("mean", "see unit", "mean over them"),
            NOTE,
        ),
    ),
    Table(
        "utterances",
        "results/naert2017/<corpus>/synthesis/utterances.csv, *_parts.csv",
        "a part of a synthetic utterance: a sign, or the transition before the next",
        (
            text("corpus", "corpus"),
            text("utterance", "name of the utterance"),
            Column("part", "", "place in the utterance, from 1"),
            text("kind", "sign or transition"),
            text("gloss", "gloss, or the two glosses of a transition"),
            text("recording", "recording that the sign is taken from"),
            Column("from_s", "s", "start of the sign in that recording"),
            Column("to_s", "s", "its end there"),
            Column("start_s", "s", "start in the utterance"),
            Column("end_s", "s", "end in the utterance"),
            Column("candidates", "", "signs of this gloss that there were to choose from"),
            text("method", "interpolation or blending"),
            text("duration_model", "model of the duration, and what it learnt from"),
            Column("euclidean_{u}", "m or px", "distance between the postures joined"),
            Column("geodesic_rad", "rad", "distance between the postures joined"),
            Column("idle_frames", "", "frames of idle posture"),
            NOTE,
        ),
    ),
    Table(
        "found_signs",
        "results/naert2017/<corpus>/synthesis/found_signs.csv",
        "the sign of a take without tags",
        (
            *LEAD,
            text("gloss", "gloss: the take's name, or as corpus.yaml says"),
            Column("start_s", "s", "start of the sign"),
            Column("end_s", "s", "end of the sign"),
            text("source", "motion (between rest parts) or corpus.yaml"),
            NOTE,
        ),
    ),
)
