"""Tables of what was read from corpora, and of what is known of simulated ones."""

from __future__ import annotations

from signkin.tables.schema import EDGE, HAND, LEAD, NOTE, SIGN, Column, Table, text

TABLES = (
    Table(
        "recordings",
        "results/<corpus>/recordings.csv",
        "a recording that was read",
        (
            *LEAD,
            text("sign", "gloss of a recording that holds one sign; empty where none does"),
            Column("repetition", "", "repetition of that sign, from 1; empty where none"),
            Column("frames", "", "number of frames"),
            Column("rate_hz", "Hz", "frames a second"),
            Column("duration_s", "s", "frames / rate"),
            text("unit", "unit of length: m or px"),
            Column("joints", "", "number of joints"),
            text("orientations", "recorded, limb_frames (made from positions) or none"),
            Column("signs", "", "tagged signs"),
            Column("clock_offset_s", "s", "added to the annotation's times (TIME_ORIGIN)"),
            Column("times_interpolated", "", "open times of the annotation, interpolated"),
            text("motion_file", "file of the motion, in the corpus's data folder"),
            text("annotation_file", "file of the annotation"),
            text("notes", "what was decided in reading the motion (an overruled rate, ...)"),
        ),
    ),
    Table(
        "excluded",
        "results/<corpus>/excluded.csv",
        "a recording that was left out because the corpus says `on_error: skip`",
        (*LEAD, text("stage", "where it failed"), text("reason", "the error's sentence")),
    ),
    Table(
        "intervals",
        "results/<corpus>/intervals.csv",
        "a tagged interval",
        (
            *LEAD,
            text("role", "sign, utterance or translation"),
            text("tier", "tier of the annotation"),
            text("label", "gloss, or the text of the utterance"),
            Column("start_s", "s", "start, from the recording's start"),
            Column("end_s", "s", "end"),
        ),
    ),
    Table(
        "gaps",
        "results/<corpus>/gaps.csv",
        "a joint of a recording that has gaps",
        (
            *LEAD,
            text("joint", "joint"),
            Column("missing_frames", "", "frames without a position"),
            Column("filled_frames", "", "of these, filled (gap no longer than longest_gap_s)"),
            Column("longest_gap_s", "s", "longest gap"),
        ),
    ),
    Table(
        "minima",
        "results/<corpus>/minima.csv",
        "a local minimum of a wrist's speed (Naert et al. 2017, section 4.1)",
        (
            *LEAD,
            HAND,
            Column("minimum_s", "s", "time of the minimum"),
            Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed at the minimum"),
            Column("prominence_{u}_per_s", "m/s or px/s", "depth below its surroundings"),
        ),
    ),
    Table(
        "plausibility",
        "results/<corpus>/plausibility.csv",
        "a check of a recording's rate and unit against what a body can do",
        (
            *LEAD,
            text("check", "what was measured"),
            Column("value", "see unit", "measured value"),
            text("unit", "its unit"),
            Column("low", "see unit", "lowest plausible value"),
            Column("high", "see unit", "highest plausible value"),
            text("verdict", "plausible, implausible or not testable"),
            NOTE,
        ),
    ),
    Table(
        "truth",
        "the corpus's own folder (truth_file in corpus.yaml)",
        "a true boundary of one hand (simulated corpora)",
        (text("recording", "recording"), SIGN, EDGE, HAND, Column("true_s", "s", "time")),
    ),
    Table(
        "design",
        "results/<corpus>/simulated/design.csv",
        "a transition as the simulator designed it",
        (
            text("recording", "recording"),
            Column("transition", "", "place of the transition in its recording, from 1"),
            text("type", "four digits"),
            Column("duration_s", "s", "duration between the manual tags"),
            Column("geodesic_rad", "rad", "distance between the postures at the true tags"),
            Column("euclidean_m", "m", "distance between the postures at the true tags"),
        ),
    ),
    Table(
        "strokes",
        "results/<corpus>/simulated/strokes.csv",
        "a stroke of the right hand as the simulator made it (simulated single signs)",
        (
            text("recording", "recording"),
            Column("stroke", "", "place of the stroke in its recording, from 1"),
            Column("onset_s", "s", "start of the stroke; the one before may not have ended"),
            Column("offset_s", "s", "end of the stroke"),
            Column("length_m", "m", "length of the stroke"),
            Column("dx_m", "m", "displacement to the signer's right"),
            Column("dy_m", "m", "displacement forward"),
            Column("dz_m", "m", "displacement upward"),
        ),
    ),
    Table(
        "true_path",
        "results/<corpus>/simulated/true_path.parquet",
        "a frame of the right wrist without the sensor's noise (simulated single signs)",
        (
            text("recording", "recording"),
            Column("frame", "", "frame, from 0"),
            Column("right_wrist_x_m", "m", "position to the signer's right"),
            Column("right_wrist_y_m", "m", "position forward"),
            Column("right_wrist_z_m", "m", "position upward"),
        ),
    ),
)
