"""The tables that the pipeline writes: their columns, units and meaning, in one place.

`docs/data-dictionary.md` is made from this module (`python -m signkin.tables`),
and a table whose columns differ from it is not written. A `{u}` in a column's
name stands for the corpus's unit of length, m or px.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from signkin.errors import SignkinError, listed

LENGTH_UNITS = ("m", "px")


@dataclass(frozen=True)
class Column:
    """One column: name, unit (empty where it has none), meaning."""

    name: str
    unit: str
    meaning: str
    text: bool = False


@dataclass(frozen=True)
class Table:
    """One kind of table: where it lies, what a row is, its columns."""

    name: str
    path: str
    row: str
    columns: tuple[Column, ...]

    def names(self, unit: str = "m") -> list[str]:
        """Return the column names for a corpus in metres or pixels."""
        return [column.name.format(u=unit) for column in self.columns]


def _text(name: str, meaning: str) -> Column:
    return Column(name, "", meaning, text=True)


_LEAD = (
    _text("corpus", "corpus, as its folder is called"),
    _text("recording", "recording, one take"),
    _text("signer", "signer, as recordings.csv names them"),
)
_HAND = _text("hand", "right or left, the signer's own")
_SIGN = Column("sign", "", "place of the sign in its recording, from 1, in order of start")
_EDGE = _text("edge", "start or end of the sign")
_NOTE = _text("note", "why a value is missing or special")

TABLES: dict[str, Table] = {
    table.name: table
    for table in (
        Table(
            "recordings",
            "results/<corpus>/recordings.csv",
            "a recording that was read",
            (
                *_LEAD,
                _text("sign", "gloss of a recording that holds one sign; empty where none does"),
                Column("repetition", "", "repetition of that sign, from 1; empty where none"),
                Column("frames", "", "number of frames"),
                Column("rate_hz", "Hz", "frames a second"),
                Column("duration_s", "s", "frames / rate"),
                _text("unit", "unit of length: m or px"),
                Column("joints", "", "number of joints"),
                _text("orientations", "recorded, limb_frames (made from positions) or none"),
                Column("signs", "", "tagged signs"),
                Column("clock_offset_s", "s", "added to the annotation's times (TIME_ORIGIN)"),
                Column("times_interpolated", "", "open times of the annotation, interpolated"),
                _text("motion_file", "file of the motion, in the corpus's data folder"),
                _text("annotation_file", "file of the annotation"),
            ),
        ),
        Table(
            "excluded",
            "results/<corpus>/excluded.csv",
            "a recording that was left out because the corpus says `on_error: skip`",
            (*_LEAD, _text("stage", "where it failed"), _text("reason", "the error's sentence")),
        ),
        Table(
            "intervals",
            "results/<corpus>/intervals.csv",
            "a tagged interval",
            (
                *_LEAD,
                _text("role", "sign, utterance or translation"),
                _text("tier", "tier of the annotation"),
                _text("label", "gloss, or the text of the utterance"),
                Column("start_s", "s", "start, from the recording's start"),
                Column("end_s", "s", "end"),
            ),
        ),
        Table(
            "gaps",
            "results/<corpus>/gaps.csv",
            "a joint of a recording that has gaps",
            (
                *_LEAD,
                _text("joint", "joint"),
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
                *_LEAD,
                _HAND,
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
                *_LEAD,
                _text("check", "what was measured"),
                Column("value", "see unit", "measured value"),
                _text("unit", "its unit"),
                Column("low", "see unit", "lowest plausible value"),
                Column("high", "see unit", "highest plausible value"),
                _text("verdict", "plausible, implausible or not testable"),
                _NOTE,
            ),
        ),
        Table(
            "boundaries",
            "results/naert2017/<corpus>/boundaries.csv",
            "a tag (an edge of a sign) for one hand, before and after refinement "
            "(Naert et al. 2017, section 4.2)",
            (
                *_LEAD,
                _SIGN,
                _text("gloss", "label of the sign"),
                _EDGE,
                Column("manual_s", "s", "time of the manual tag"),
                _HAND,
                Column("minimum_s", "s", "speed minimum of this hand nearest to the tag"),
                Column("refined_s", "s", "time after refinement"),
                Column("moved", "", "whether the tag was moved to a minimum"),
                Column("distance_s", "s", "from the tag to the nearest minimum"),
                _text("status", "moved, far (no minimum in the window) or taken (see note)"),
                _NOTE,
            ),
        ),
        Table(
            "transitions",
            "results/naert2017/<corpus>/transitions.csv",
            "a transition between two signs of one utterance, for one segmentation and hand "
            "(Naert et al. 2017, section 5.1)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("previous_gloss", "sign before"),
                _text("next_gloss", "sign after"),
                _text(
                    "type",
                    "four digits: hands and symmetry of the sign before, then of the sign after "
                    "(hands: 0 one, 1 two, 2 one with the other keeping the context)",
                ),
                _text("type_source", "lexicon (signs.csv) or kinematic (inferred from motion)"),
                _text("hand", "both (whole body), right or left (arm joints of that hand)"),
                _text("segmentation", "manual or refined"),
                _text("utterance", "utterance the transition belongs to"),
                Column("start_s", "s", "end of the sign before"),
                Column("end_s", "s", "start of the sign after"),
                Column("duration_s", "s", "end - start; below 0 where the signs overlap"),
                _text("status", "ok, zero_length or overlap"),
                Column("geodesic_rad", "rad", "eq. 1, mean over joints of half the rotation angle"),
                Column("euclidean_{u}", "m or px", "eq. 2, mean over joints"),
                Column("n_joints", "", "joints in the Euclidean mean (gaps left out)"),
                Column("geodesic_norm", "", "geodesic, mean taken off, divided by the range"),
                Column("euclidean_norm", "", "Euclidean, mean taken off, divided by the range"),
                Column("mean_distance", "", "mean of the two (of the one, where one is missing)"),
                _NOTE,
            ),
        ),
        Table(
            "sign_types",
            "results/naert2017/<corpus>/sign_types.csv",
            "a sign's type from the lexicon and from motion",
            (
                *_LEAD,
                _SIGN,
                _text("gloss", "label of the sign"),
                Column("start_s", "s", "start of the sign"),
                Column("end_s", "s", "end of the sign"),
                _text("utterance", "utterance the sign belongs to, empty for none"),
                _text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
                _text("kinematic", "two digits from motion"),
                _text("type", "the two digits in use"),
                _text("type_source", "lexicon or kinematic"),
                Column("activity", "", "path of the stiller wrist / path of the busier one"),
                Column("mirror", "", "correlation of the wrists' velocities, one mirrored"),
                Column(
                    "held_shift", "", "shift of the still wrist since the sign before, in reaches"
                ),
                _NOTE,
            ),
        ),
        Table(
            "lexicon",
            "results/naert2017/<corpus>/lexicon.csv",
            "a gloss of signs.csv or of the annotation",
            (
                _text("corpus", "corpus"),
                _text("gloss", "gloss"),
                _text("lexicon", "two digits from signs.csv, empty where the gloss is missing"),
                Column("occurrences", "", "signs with this gloss in the corpus"),
                _NOTE,
            ),
        ),
        Table(
            "table1",
            "results/naert2017/<corpus>/table1.csv",
            "an utterance (Naert et al. 2017, Table 1)",
            (
                *_LEAD,
                _text("utterance", "utterance"),
                Column("start_s", "s", "start"),
                Column("end_s", "s", "end"),
                Column("signs", "", "number of signs"),
                _text("glosses", "the signs in order"),
                _text("translation", "translation, where the corpus has one"),
            ),
        ),
        Table(
            "table2",
            "results/naert2017/<corpus>/table2.csv",
            "a transition type (Naert et al. 2017, Table 2), or `all`",
            (
                _text("corpus", "corpus"),
                _text("type", "four digits, or all"),
                Column("n", "", "transitions"),
                Column("mean_s", "s", "mean duration"),
                Column("sd_s", "s", "standard deviation, divisor n - 1"),
                Column("n_without_outlier", "", "transitions that are no outliers"),
                Column("mean_without_outlier_s", "s", "their mean"),
                Column("sd_without_outlier_s", "s", "their standard deviation"),
                _text("printed_n", "number as the paper would print it; (without outliers)"),
                _text("printed_mean", "mean so printed, rounded half up"),
                _text("printed_sd", "standard deviation so printed"),
                _text("published_n", "number in Naert et al. 2017, Table 2"),
                _text("published_mean", "mean there"),
                _text("published_sd", "standard deviation there"),
                _text("equal", "yes or no: whether printed and published agree in every digit"),
                _NOTE,
            ),
        ),
        Table(
            "fig10",
            "results/naert2017/<corpus>/fig10.csv",
            "a change in the number of hands (Naert et al. 2017, Fig. 10; type 2 is two-handed)",
            (
                _text("corpus", "corpus"),
                _text("change", "1H to 1H, 1H to 2H, 2H to 1H or 2H to 2H"),
                Column("n", "", "transitions"),
                Column("mean_s", "s", "mean duration"),
                Column("sd_s", "s", "standard deviation, divisor n - 1"),
                Column("published_n", "", "transitions, summed from the paper's Table 2"),
                Column("published_mean_s", "s", "mean that follows from the paper's Table 2"),
            ),
        ),
        Table(
            "diamond",
            "results/naert2017/<corpus>/diamond.csv",
            "a corner of the diamond of Fig. 8",
            (
                _text("corpus", "corpus"),
                _text("corner", "left, top, right or bottom"),
                Column("mean_distance", "", "average normalised distance at the corner"),
                Column("duration_s", "s", "duration at the corner"),
                Column("share_inside", "", "share of the transitions that the diamond holds"),
                Column("n", "", "transitions"),
            ),
        ),
        Table(
            "excerpt",
            "results/naert2017/<corpus>/fig04.csv, fig05.csv, fig06.csv",
            "a point of a speed figure (Naert et al. 2017, Fig. 4-6)",
            (
                _text("corpus", "corpus"),
                _text("recording", "recording the excerpt is taken from"),
                _text("kind", "speed, tag, minimum or refined"),
                _text("hand", "right or left; both for tags"),
                _text("edge", "start or end of a sign, for tags and refined tags"),
                _text("gloss", "sign the tag belongs to"),
                _text("status", "moved, far or taken, for refined tags (see boundaries)"),
                Column("time_s", "s", "time in the recording"),
                Column("speed_{u}_per_s", "m/s or px/s", "low-passed speed of the wrist"),
            ),
        ),
        Table(
            "distances",
            "results/naert2017/<corpus>/fig07.csv, fig08.csv",
            "a transition between manual tags, overlapping signs left out (Fig. 7, 8)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("type", "four digits"),
                Column("mean_distance", "", "average of the two normalised distances"),
                Column("duration_s", "s", "duration"),
                Column("outlier", "", "whether the outlier rule marks it"),
                Column("in_diamond", "", "whether the diamond of Fig. 8 holds it"),
            ),
        ),
        Table(
            "segmentations",
            "results/naert2017/<corpus>/fig09.csv",
            "a transition of one hand with manual and with refined tags (Fig. 9)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _HAND,
                Column("manual_euclidean_{u}", "m or px", "distance of the arm's joints"),
                Column("manual_duration_s", "s", "duration between manual tags"),
                Column("refined_euclidean_{u}", "m or px", "distance, refined tags"),
                Column("refined_duration_s", "s", "duration between refined tags"),
            ),
        ),
        Table(
            "refinement",
            "results/naert2017/<corpus>/refinement.csv",
            "a measure of how the tags lie to the speed minima, per hand, against chance",
            (
                _text("corpus", "corpus"),
                _HAND,
                _text("measure", "what is measured"),
                Column("value", "see unit", "for the manual tags"),
                _text("unit", "its unit"),
                Column("chance", "see unit", "mean over sets of tags placed at random"),
                Column("chance_low", "see unit", "2.5 % quantile over these sets"),
                Column("chance_high", "see unit", "97.5 % quantile"),
                Column("n", "", "tags (or pairs of tags)"),
                _NOTE,
            ),
        ),
        Table(
            "truth_error",
            "results/naert2017/<corpus>/truth_error.csv",
            "the error of the tags of one hand to the known truth (simulated corpora)",
            (
                _text("corpus", "corpus"),
                _HAND,
                _text("segmentation", "manual or refined"),
                Column("n", "", "tags with a known truth"),
                Column("mean_error_s", "s", "mean absolute error"),
                Column("low_s", "s", "2.5 % bootstrap quantile of the mean"),
                Column("high_s", "s", "97.5 % bootstrap quantile"),
                Column("median_error_s", "s", "median absolute error"),
                Column("within_20ms", "", "share of tags within 0.02 s of the truth"),
            ),
        ),
        Table(
            "surface",
            "results/naert2017/<corpus>/surface.csv",
            "a coefficient of the duration surface (Naert et al. 2017, section 5.2, eq. 4)",
            (
                _text("corpus", "corpus"),
                _text("coefficient", "constant, geodesic or euclidean"),
                _text("published", "theta as printed"),
                Column("fitted", "s, s/rad, s/unit", "least squares on the manual transitions"),
                Column("low", "same", "95 % interval, low"),
                Column("high", "same", "95 % interval, high"),
                Column("designed", "same", "fit on the distances a simulation was designed with"),
                Column("shift_percent", "%", "fitted against published"),
                Column("n", "", "transitions"),
                Column("mean_error_s", "s", "eq. 5 of the fit"),
            ),
        ),
        Table(
            "transition_speeds",
            "results/naert2017/<corpus>/transition_speeds.csv",
            "a transition between manual tags with the mean speeds of the signs around it "
            "(Naert et al. 2017, section 5.2, eq. 3)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                *(
                    Column(f"{side}_{kind}", unit, meaning.format(which))
                    for kind, unit, meaning in (
                        (
                            "linear_speed_{u}_per_s",
                            "m/s or px/s",
                            "mean speed over joints and frames of the sign {}, low-passed",
                        ),
                        (
                            "angular_speed_rad_per_s",
                            "rad/s",
                            "same of the orientations, the angle as eq. 1 has it (half)",
                        ),
                    )
                    for side, which in (("previous", "before"), ("next", "after"))
                ),
                _NOTE,
            ),
        ),
        Table(
            "statistics",
            "results/naert2017/<corpus>/statistics.csv",
            "a test on the durations between manual tags, with one of its effect sizes (Naert et "
            "al. 2017, section 5.1); an empty number is one that the test does not have, or whose "
            "note says what is missing",
            (
                _text("corpus", "corpus"),
                _text(
                    "question",
                    "type (four digits), hands, symmetry, change of hands (Fig. 10) or distance",
                ),
                _text("outliers", "none (the rule finds none), kept or left out"),
                _text("test", "test; `in words`: what follows from the others"),
                _text("comparison", "what is compared with what"),
                _text("statistic_name", "F, W, H, t, r, chi squared, SD (s) or difference (s)"),
                Column("statistic", "see statistic_name", "value of the statistic"),
                Column("df1", "", "degrees of freedom, of the numerator"),
                Column("df2", "", "degrees of freedom, of the error"),
                Column("p", "", "p, adjusted for all pairs in post-hoc tests"),
                _text(
                    "effect_name",
                    "kind of the effect size; (partial) eta and omega squared "
                    "estimate the same share of variance, and share its interval",
                ),
                Column("effect", "see effect_name", "effect size"),
                Column("effect_low", "see effect_name", "its interval (config: durations.alpha)"),
                Column("effect_high", "see effect_name", "its interval"),
                Column("n", "", "transitions"),
                _text("assumptions", "checks of the test's assumptions"),
                Column("power", "", "power of this test at this n, for the effect in power_for"),
                _text("power_for", "effect that the power is told for"),
                _NOTE,
            ),
        ),
        Table(
            "duration_coefficients",
            "results/naert2017/<corpus>/duration_coefficients.csv",
            "a coefficient of a duration model (Naert et al. 2017, section 5.2)",
            (
                _text("corpus", "corpus"),
                _text("model", "LINEAR or SURFACE"),
                _text("coefficient", "constant, mean_distance, geodesic or euclidean"),
                _text("unit", "unit of the coefficient"),
                _text("published", "as printed, empty where the paper prints none"),
                Column("fitted", "see unit", "least squares on the manual transitions"),
                Column("standard_error", "see unit", "its standard error"),
                Column("low", "see unit", "interval by Student's t (config: durations.alpha)"),
                Column("high", "see unit", "interval by Student's t"),
                Column("bootstrap_low", "see unit", "bootstrap interval"),
                Column("bootstrap_high", "see unit", "bootstrap interval"),
                _text("published_inside", "yes or no: whether both intervals hold the printed one"),
                Column("n", "", "transitions"),
                _NOTE,
            ),
        ),
        Table(
            "duration_models",
            "results/naert2017/<corpus>/duration_models.csv",
            "a duration model and how it was tested (Naert et al. 2017, section 5.2)",
            (
                _text("corpus", "corpus"),
                _text(
                    "model",
                    "MEAN (baseline), SIMPLE, SIMPLE_BOUNDED, LINEAR, SURFACE or "
                    "SURFACE_PRINTED (theta as printed, nothing learnt)",
                ),
                _text("evaluation", "in_sample, leave_one_out or leave_one_recording_out"),
                Column("n", "", "transitions, the same for all models of a corpus"),
                Column("mean_error_s", "s", "mean absolute error (eq. 5)"),
                Column("mean_error_low_s", "s", "its bootstrap interval"),
                Column("mean_error_high_s", "s", "its bootstrap interval"),
                Column("gain_s", "s", "mean error of MEAN in the same evaluation less this one's"),
                Column("gain_low_s", "s", "its bootstrap interval (paired)"),
                Column("gain_high_s", "s", "its bootstrap interval (paired)"),
                Column("rmse_s", "s", "root of the mean squared error"),
                Column("bias_s", "s", "mean of predicted - true; above 0: too long"),
                Column("longest_s", "s", "longest prediction"),
                Column("share_above_bound", "", "share predicted longer than durations.highest_s"),
                _NOTE,
            ),
        ),
        Table(
            "duration_predictions",
            "results/naert2017/<corpus>/fig_durations.csv",
            "a transition as a duration model predicts it when it learnt from all others",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("model", "as in duration_models"),
                Column("duration_s", "s", "duration between manual tags"),
                Column("predicted_s", "s", "prediction, leave-one-out"),
            ),
        ),
        Table(
            "surface_points",
            "results/naert2017/<corpus>/fig11.csv",
            "a transition and the fitted surface at its distances (Naert et al. 2017, Fig. 11)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                Column("geodesic_rad", "rad", "eq. 1, mean over joints"),
                Column("euclidean_units", "euclidean_unit_m", "eq. 2, mean over joints"),
                Column("duration_s", "s", "duration between manual tags"),
                Column("surface_s", "s", "surface there, in sample; empty without a surface"),
            ),
        ),
        Table(
            "synthesis",
            "results/naert2017/<corpus>/synthesis/synthesis.csv",
            "a captured transition made anew by one method with one duration "
            "(Naert et al. 2017, sections 3.1 and 5.2)",
            (
                *_LEAD,
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("previous_gloss", "sign before"),
                _text("next_gloss", "sign after"),
                _text(
                    "material",
                    "own: the two signs themselves; other: other signs of the same two glosses, "
                    "so that the captured transition is not seen",
                ),
                _text("method", "interpolation or blending"),
                _text(
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
                _NOTE,
            ),
        ),
        Table(
            "synthesis_summary",
            "results/naert2017/<corpus>/synthesis/synthesis_summary.csv",
            "an error of one method with one duration, over the transitions that all methods "
            "have a value for; the smaller, the nearer to real signing",
            (
                _text("corpus", "corpus"),
                _text("material", "own or other (see synthesis)"),
                _text("measure", "which error"),
                _text("unit", "its unit; |ln ratio|: none"),
                _text("method", "interpolation or blending; either, where it does not matter"),
                _text("duration_model", "simple, simple_bounded, linear, surface or true"),
                Column("transitions", "", "transitions made"),
                Column("n", "", "of these, with a value for every method"),
                Column("mean", "see unit", "mean error"),
                Column("low", "see unit", "2.5 % bootstrap quantile (transitions resampled)"),
                Column("high", "see unit", "97.5 % bootstrap quantile"),
                Column("over_best", "see unit", "mean error over that of the nearest method"),
                Column("over_best_low", "see unit", "2.5 % bootstrap quantile, paired"),
                Column("over_best_high", "see unit", "97.5 % bootstrap quantile, paired"),
                _text(
                    "nearest",
                    "nearest (least mean error), as near (the interval of over_best holds 0), "
                    "farther, or reference (true duration)",
                ),
                _NOTE,
            ),
        ),
        Table(
            "utterances",
            "results/naert2017/<corpus>/synthesis/*.csv with _parts in the name",
            "a part of a synthetic utterance: a sign, or the transition before the next",
            (
                _text("corpus", "corpus"),
                _text("utterance", "name of the utterance"),
                Column("part", "", "place in the utterance, from 1"),
                _text("kind", "sign or transition"),
                _text("gloss", "gloss, or the two glosses of a transition"),
                _text("recording", "recording that the sign is taken from"),
                Column("from_s", "s", "start of the sign in that recording"),
                Column("to_s", "s", "its end there"),
                Column("start_s", "s", "start in the utterance"),
                Column("end_s", "s", "end in the utterance"),
                Column("candidates", "", "signs of this gloss that there were to choose from"),
                _text("method", "interpolation or blending"),
                _text("duration_model", "model of the duration, and what it learnt from"),
                Column("euclidean_{u}", "m or px", "distance between the postures joined"),
                Column("geodesic_rad", "rad", "distance between the postures joined"),
                Column("idle_frames", "", "frames of idle posture"),
                _NOTE,
            ),
        ),
        Table(
            "found_signs",
            "results/naert2017/<corpus>/synthesis/found_signs.csv",
            "the sign of a take without tags",
            (
                *_LEAD,
                _text("gloss", "gloss: the take's name, or as corpus.yaml says"),
                Column("start_s", "s", "start of the sign"),
                Column("end_s", "s", "end of the sign"),
                _text("source", "motion (between rest parts) or corpus.yaml"),
                _NOTE,
            ),
        ),
        Table(
            "skeletons",
            "results/naert2017/<corpus>/fig01.csv, fig02.csv, fig12.csv, fig13.csv",
            "a joint of a drawn posture, or a point of a drawn speed curve",
            (
                _text("corpus", "corpus"),
                _text("panel", "which part of the figure"),
                _text("motion", "what is drawn: captured, or method and duration"),
                _text("kind", "joint or speed"),
                _text("joint", "joint, or the hand of a speed"),
                Column("time_s", "s", "time from the start of the transition"),
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
                _text("rule", "rule"),
                _text("stage", "file in workflow/rules it stands in"),
                _text("note", "what it does"),
                Column("column", "", "place from left to right among the rules of its stage"),
                Column("row", "", "place from top to bottom; a stage has rows of its own"),
                _text("after", "rules whose output it takes, those behind others left out"),
            ),
        ),
        Table(
            "truth",
            "the corpus's own folder (truth_file in corpus.yaml)",
            "a true boundary of one hand (simulated corpora)",
            (_text("recording", "recording"), _SIGN, _EDGE, _HAND, Column("true_s", "s", "time")),
        ),
        Table(
            "design",
            "results/<corpus>/simulated/design.csv",
            "a transition as the simulator designed it",
            (
                _text("recording", "recording"),
                Column("transition", "", "place of the transition in its recording, from 1"),
                _text("type", "four digits"),
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
                _text("recording", "recording"),
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
                _text("recording", "recording"),
                Column("frame", "", "frame, from 0"),
                Column("right_wrist_x_m", "m", "position to the signer's right"),
                Column("right_wrist_y_m", "m", "position forward"),
                Column("right_wrist_z_m", "m", "position upward"),
            ),
        ),
    )
}


# --- the audit -------------------------------------------------------------------------------

_CLAIM = (
    _text("paper", "folder of the paper below papers/"),
    _text("id", "claim, as papers/<paper>/claims.yaml names it"),
    _text("location", "section, table or figure of the paper"),
    _text("evidence", "published numbers, or a corpus"),
    _text("evidence_kind", "published numbers, simulated (a test of the method) or real"),
)
for _table in (
    Table(
        "claims",
        "results/audit/claims.csv",
        "a claim of a paper on one piece of evidence",
        (
            *_CLAIM,
            _text("claim", "what is claimed, in our words"),
            _text("printed", "the numbers as printed"),
            _text("recomputed", "the numbers recomputed"),
            _text("interval", "what rounding allows them to be; on a corpus, 95 % by bootstrap"),
            _text(
                "verdict",
                "consistent or inconsistent (published numbers), holds or fails (corpora), or "
                "not testable",
            ),
            _text("note", "why, or what is missing"),
            _text("source", "tables behind it"),
        ),
    ),
    Table(
        "checks",
        "results/audit/checks.csv",
        "a finding of a check",
        (
            *_CLAIM,
            _text("check", "check, as the claim names it"),
            _text("counts", "yes; or `beside the claim`: told, without a say in its verdict"),
            _text("item", "row of the printed table that the finding is about"),
            _text("reads", "how the claim is read"),
            _text("printed", "as printed"),
            _text("recomputed", "recomputed"),
            _text(
                "interval",
                "what rounding allows; on a corpus, 95 % by bootstrap, or what chance gives",
            ),
            _text("verdict", "consistent, inconsistent, undecidable; holds, fails; not testable"),
            _text("why", "one sentence"),
            _text("source", "table behind it"),
        ),
    ),
    Table(
        "multiverse",
        "results/naert2017/<corpus>/multiverse.csv",
        "a claim under one specification: a combination of choices that the paper leaves open",
        (
            _text("corpus", "corpus"),
            _text("claim", "claim of Naert et al. 2017"),
            _text("segmentation", "manual or refined tags"),
            _text("hand", "right, left or both"),
            Column("cutoff_hz", "Hz", "low-pass, half gain; empty where it plays no part"),
            Column("prominence", "", "least depth of a minimum; empty where it plays no part"),
            Column("window_s", "s", "refinement window; empty where it plays no part"),
            _text("outliers", "kept or left out; empty where it plays no part"),
            _text("statistic", "what the estimate is"),
            Column("estimate", "see statistic", "the number the claim is about"),
            Column("bound", "see statistic", "what it is set against"),
            Column("holds", "", "whether the claim holds so"),
            Column("n", "", "transitions or tags"),
            _NOTE,
        ),
    ),
    Table(
        "specifications",
        "results/audit/<claim>_specifications.csv",
        "a level of a choice in the specification curve of a claim, or `all`",
        (
            _text("paper", "folder of the paper below papers/"),
            _text("claim", "claim"),
            _text("corpus", "corpus"),
            _text("choice", "choice that the paper leaves open, or all"),
            _text("level", "its value"),
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
            _NOTE,
        ),
    ),
):
    TABLES[_table.name] = _table


_NOT_YET = ("geodesic_norm", "euclidean_norm", "mean_distance", "note")
TABLES["raw_transitions"] = Table(
    "raw_transitions",
    "results/naert2017/<corpus>/shards/<shard>/transitions.csv",
    "a transition before distances are normalised, which wants the whole corpus",
    tuple(c for c in TABLES["transitions"].columns if c.name not in _NOT_YET),
)

# --- Endres et al. 2013 -----------------------------------------------------------------------

_DATASET = _text("dataset", "recorded, powerlaw, fitted or fitted_map")
_TRUE_ORDER = Column(
    "true_order", "", "order of the polynomials that fitted trajectories were made with"
)
_ORDER = Column("order", "", "polynomial order S")
_SINGLE_SIGN = _text("sign", "the recording's sign")
_GROUP = (
    _text("corpus", "corpus, as its folder is called"),
    _DATASET,
    _TRUE_ORDER,
    _text("signer", "signer, or `all`"),
    _text("sign", "sign, or `all`"),
)
_COUNTED = (
    Column("n", "", "trajectories"),
    Column("without_truth", "", "of these, without a true boundary: in no hit rate"),
)

TABLES |= {
    table.name: table
    for table in (
        Table(
            "ground_truth",
            "results/endres2013/<corpus>/ground_truth.csv",
            "a segment of a power-law ground truth (section 2.4)",
            (
                *_LEAD,
                Column("segment", "", "place of the segment, from 1"),
                Column("end_s", "s", "its end, from the start of the warped movement"),
                Column("duration_s", "s", "its duration after warping"),
                Column("recorded_duration_s", "s", "its duration as recorded"),
                Column("beta", "", "exponent as drawn"),
                Column("alpha", "(m or px)^(1 + beta)/s", "gain as it follows from continuity"),
                Column("fitted_beta", "", "exponent, fitted again to the warped samples"),
                Column("fitted_alpha", "(m or px)^(1 + beta)/s", "gain, fitted again"),
                Column("r_squared", "", "R squared of that fit (eq. 5)"),
                Column("top_speed_{u}_per_s", "m/s or px/s", "top speed after warping"),
                Column("recorded_top_speed_{u}_per_s", "m/s or px/s", "top speed as recorded"),
                Column("straight_share", "", "share of the path that counts as straight"),
                Column("draws", "", "draws until one was accepted, that one too"),
            ),
        ),
        Table(
            "rejected_draws",
            "results/endres2013/<corpus>/rejected_draws.csv",
            "a reason why draws of ground truth were rejected, of one recording",
            (
                *_LEAD,
                Column("draws", "", "draws in all"),
                _text("reason", "why draws were rejected"),
                Column("rejected", "", "how many, for this reason"),
            ),
        ),
        Table(
            "binning_left_out",
            "results/endres2013/<corpus>/left_out.csv",
            "a trajectory that was not binned",
            (*_LEAD, _DATASET, _text("reason", "why it was left out")),
        ),
        Table(
            "binning",
            "results/endres2013/<corpus>/binning.csv",
            "a trajectory and a polynomial order (section 3)",
            (
                *_LEAD,
                _SINGLE_SIGN,
                Column("repetition", "", "its number among the repetitions"),
                _DATASET,
                _TRUE_ORDER,
                _text("prior_id", "degrees of freedom, noise, scale, concentration, time unit"),
                Column("n_bins", "", "bins T"),
                Column("duration_s", "s", "duration of all bins"),
                _ORDER,
                Column("log_evidence", "", "ln P(D | S), summed over M"),
                Column("order_probability", "", "P(S | D)"),
                Column("map_count", "", "most probable number M of inner boundaries"),
                Column("expected_count", "", "expected number of inner boundaries"),
                Column("cut_mass", "", "bound on the share of P(M | D, S) that was cut off"),
                Column("explained_variance", "", "of the trajectory by its expectation"),
                Column("hits", "", "true boundaries that were found"),
                Column("misses", "", "true boundaries that were not"),
                Column("false_positives", "", "boundaries found that are none"),
                Column("hit_rate", "", "hits over true boundaries"),
                Column("false_positives_per_s", "1/s", "false positives a second"),
                Column("hpfpps", "s", "hit rate over false positives a second (eq. 17)"),
                _NOTE,
            ),
        ),
        Table(
            "fitted_truths",
            "results/endres2013/<corpus>/fitted_truths.csv",
            "a boundary of a fitted trajectory, which binning is to find again",
            (
                *_LEAD,
                _DATASET,
                _TRUE_ORDER,
                Column("boundary_s", "s", "from the start of the movement"),
            ),
        ),
        Table(
            "order_posteriors",
            "results/endres2013/<corpus>/order_posteriors.csv",
            "the order posterior of a group of trajectories, at one order (Fig. 3B, 6, 7, A1)",
            (
                *_GROUP,
                _ORDER,
                Column("mean_probability", "", "mean of P(S | D) over trajectories"),
                Column("se", "", "its standard error"),
                Column("mean_count", "", "mean of the most probable M"),
                Column("mean_explained_variance", "", "mean of the explained variance"),
                Column("sd_explained_variance", "", "its standard deviation"),
                Column("n", "", "trajectories"),
            ),
        ),
        Table(
            "hit_rates",
            "results/endres2013/<corpus>/hit_rates.csv",
            "the hit rate of a group of trajectories, at one order (Fig. 3C, 5, 6, A1)",
            (
                *_GROUP,
                _ORDER,
                Column("hit_rate", "", "mean over trajectories"),
                Column("hit_rate_se", "", "its standard error"),
                Column("false_positives_per_s", "1/s", "mean over trajectories"),
                Column("false_positives_per_s_se", "1/s", "its standard error"),
                Column("chance_hit_rate", "", "of Poisson events with as many false positives"),
                Column("chance_low", "", "2.5 % of sets of such events"),
                Column("chance_high", "", "97.5 %"),
                Column("hpfpps", "s", "pooled hit rate over pooled false positives a second"),
                Column("hpfpps_se", "s", "its bootstrap standard error, over finite draws"),
                Column("hpfpps_low", "s", "2.5 % of the draws"),
                Column("hpfpps_high", "s", "97.5 %"),
                Column("unbounded_draws", "", "draws without a false positive"),
                *_COUNTED,
                _NOTE,
            ),
        ),
        Table(
            "chance_lines",
            "results/endres2013/<corpus>/chance_lines.csv",
            "a point of a line of no discrimination (section 3.1)",
            (
                *_GROUP,
                Column("rate_per_s", "1/s", "rate of the Poisson events"),
                Column("false_positives_per_s", "1/s", "mean of the simulated events"),
                Column("hit_rate", "", "mean of the simulated events, matched one to one"),
                Column("hit_rate_low", "", "2.5 % of the simulated sets"),
                Column("hit_rate_high", "", "97.5 %"),
                Column("closed_form", "", "1 - exp(-2 w rate)"),
            ),
        ),
        Table(
            "order_tests",
            "results/endres2013/<corpus>/order_tests.csv",
            "a test of orders against each other by eq. 17, power-law ground truth (section 3.2)",
            (
                _text("corpus", "corpus, as its folder is called"),
                _text("question", "what is asked"),
                _text("test", "Kruskal-Wallis, or Friedman with the trajectory as a block"),
                Column("statistic", "", "H or chi squared"),
                Column("df", "", "degrees of freedom"),
                Column("p", "", "p, of ranks; hits without a false positive are a tied top"),
                Column("n", "", "values, or blocks"),
                Column("left_out", "", "values or blocks with neither hit nor false positive"),
                Column("without_truth", "", "trajectories without a true boundary"),
                _NOTE,
            ),
        ),
        Table(
            "fig01_powerlaw",
            "results/endres2013/<corpus>/fig01.csv",
            "a sample of the recording drawn in Fig. 1, recorded or warped",
            (
                *_LEAD,
                _DATASET,
                Column("time_s", "s", "from the start of the movement"),
                Column("segment", "", "segment of the ground truth, from 1"),
                *(Column(f"{axis}_{{u}}", "m or px", "position") for axis in "xyz"),
                Column("speed_{u}_per_s", "m/s or px/s", "speed"),
                Column("curvature_per_{u}", "1/m or 1/px", "curvature, not below straight"),
                Column("predicted_speed_{u}_per_s", "m/s or px/s", "by the laws fitted again"),
            ),
        ),
        Table(
            "endres_figure",
            "results/endres2013/<corpus>/fig03.csv to fig07.csv, figA1.csv",
            "a point drawn in a figure",
            (
                _text("corpus", "corpus, as its folder is called"),
                _text("panel", "panel, as in the figure"),
                _text("series", "line or kind of mark"),
                Column("x", "", "as the panel's horizontal axis says"),
                Column("y", "", "as the panel's vertical axis says"),
                Column("x_error", "", "standard error of x, where drawn"),
                Column("y_error", "", "standard error (Fig. 3D: deviation) of y, where drawn"),
                _text("label", "what is written beside it"),
            ),
        ),
        Table(
            "sensitivity",
            "results/endres2013/<corpus>/sensitivity.csv",
            "a setting of what the paper does not print, and its results on some recordings",
            (
                _text("corpus", "corpus, as its folder is called"),
                _text("dof", "degrees of freedom of the prior; L: number of dimensions"),
                _text("noise", "sensor or data, expected or plain scale"),
                Column("concentration", "", "b"),
                _text("time_unit", "bin, second or trajectory"),
                Column("bins", "", "T"),
                _text("printed", "yes where it agrees with all that section 3.2 prints"),
                _text("default", "yes where it is the setting of config.yaml"),
                *(
                    Column(f"mean_count_order_{s}", "", f"mean M of recorded ones, order {s}")
                    for s in (0, 3, 7)
                ),
                Column("explained_variance_order_3", "", "mean of recorded ones, order 3"),
                Column("order_peak_recorded", "", "order with the highest mean posterior"),
                Column("probability_3_to_5_recorded", "", "mean P(3 <= S <= 5 | D)"),
                Column("order_peak_powerlaw", "", "the same peak, power-law ground truth"),
                Column("hit_rate_order_3", "", "mean, power-law ground truth"),
                Column("false_positives_per_s_order_3", "1/s", "mean, power-law ground truth"),
                Column("chance_high_order_3", "", "97.5 % of sets of as many Poisson events"),
                Column("hpfpps_order_3", "s", "pooled, power-law ground truth"),
                _text("hpfpps_peak", "orders with the highest pooled ratio"),
                Column("recovered_probability", "", "fitted_map of order 3: mean P(S = 3 | D)"),
                Column("recovered_hit_rate", "", "fitted_map of order 3, binned with order 3"),
                Column("recordings", "", "recordings that were run"),
                _NOTE,
            ),
        ),
        Table(
            "wrist_boundaries",
            "results/endres2013/<corpus>/wrist_boundaries.csv",
            "a boundary that binning finds in a continuous recording",
            (
                *_LEAD,
                _HAND,
                Column("boundary_s", "s", "its time"),
                Column("probability", "", "posterior of a boundary at most 3 bins away"),
            ),
        ),
        Table(
            "wrist_posteriors",
            "results/endres2013/<corpus>/wrist_posteriors.csv",
            "a wrist of a continuous recording, as a long series",
            (
                *_LEAD,
                _HAND,
                Column("n_bins", "", "bins T"),
                Column("bin_s", "s", "duration of a bin"),
                _ORDER,
                Column("map_count", "", "most probable number M of inner boundaries"),
                Column("boundaries_per_s", "1/s", "boundaries found, a second"),
                Column("cut_mass", "", "bound on the share of P(M | D, S) that was cut off"),
                Column("explained_variance", "", "of the wrist's path by its expectation"),
                _NOTE,
            ),
        ),
        Table(
            "one_wrist",
            "results/endres2013/<corpus>/one_wrist.csv",
            "boundaries by binning against what the other study finds on the same wrist",
            (
                _text("corpus", "corpus, as its folder is called"),
                _HAND,
                _text("found", "what is looked at: boundaries, minima or tags"),
                _text("truth", "against what: minima, tags or refined tags"),
                Column("window_s", "s", "half-width of the window"),
                Column("hits", "", "pairs within the window, one to one"),
                Column("hit_rate", "", "of the truth that was hit, mean over recordings"),
                Column("false_positives_per_s", "1/s", "found and no hit, mean over recordings"),
                Column("chance_hit_rate", "", "of as many Poisson events: mean of the draws"),
                Column("chance_low", "", "2.5 % of the draws"),
                Column("chance_high", "", "97.5 %"),
                Column("n_found", "", "events found"),
                Column("n_truth", "", "events they are held against"),
                Column("recordings", "", "recordings"),
                _NOTE,
            ),
        ),
    )
}


def write_table(frame: pd.DataFrame, path: str | Path, name: str, unit: str = "m") -> None:
    """Write a table whose columns are those of its kind, in their order.

    A path that ends in .parquet gives Parquet with every bit; else CSV, times to 1 ns.
    """
    expected = TABLES[name].names(unit)
    if list(frame.columns) != expected:
        missing = [column for column in expected if column not in frame.columns]
        extra = [column for column in frame.columns if column not in expected]
        raise SignkinError(
            f"columns missing: {listed(missing)}; not declared: {listed(extra)}",
            file=path,
            place=f"table {name}",
            expected=listed(expected, 40),
        )
    if Path(path).suffix == ".parquet":
        frame.to_parquet(path, index=False)
        return
    frame.to_csv(path, index=False, float_format="%.9g", lineterminator="\n")


def read_table(path: str | Path, name: str) -> pd.DataFrame:
    """Read a table as it was written: text stays text (`0000`), an empty cell of text is ''."""
    kinds = {n: c for c in TABLES[name].columns for n in {c.name.format(u=u) for u in LENGTH_UNITS}}
    header = pd.read_csv(path, nrows=0).columns
    text = [column for column in header if column in kinds and kinds[column].text]
    frame = pd.read_csv(
        path,
        dtype=dict.fromkeys(text, "str"),
        keep_default_na=False,
        na_values={column: [""] for column in header if column not in text},
    )
    return frame


def concatenated(paths: Iterable[str | Path], name: str, unit: str = "m") -> pd.DataFrame:
    """Read tables of one kind and put them below one another, in the order given."""
    parts = [read_table(path, name) for path in paths]
    kept = [part for part in parts if len(part)]
    return pd.concat(kept, ignore_index=True) if kept else empty(name, unit)


def empty(name: str, unit: str = "m") -> pd.DataFrame:
    """Return a table without rows."""
    return pd.DataFrame(columns=TABLES[name].names(unit))


def dictionary() -> str:
    """Return the data dictionary as Markdown."""
    lines = [
        "# Data dictionary",
        "",
        "Made from `src/signkin/tables.py` by `python -m signkin.tables`; edit it there.",
        "A `{u}` in a name is the corpus's unit of length, `m` or `px`. An empty cell is a value",
        "that does not exist; where it needs saying, the column `note` says why.",
    ]
    for table in TABLES.values():
        lines += ["", f"## {table.name}", "", f"`{table.path}`: one row is {table.row}.", ""]
        lines += ["| column | unit | meaning |", "|---|---|---|"]
        lines += [f"| `{c.name}` | {c.unit} | {c.meaning} |" for c in table.columns]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(dictionary(), end="")
