"""Statistics and models of durations (Naert et al. 2017, sections 5.1 and 5.2)."""

from __future__ import annotations

from signkin.tables.schema import LEAD, NOTE, Column, Table, text

TABLES = (
    Table(
        "statistics",
        "results/naert2017/<corpus>/statistics.csv",
        "a test on the durations between manual tags, with one of its effect sizes (Naert et "
        "al. 2017, section 5.1); an empty number is one that the test does not have, or whose "
        "note says what is missing",
        (
            text("corpus", "corpus"),
            text(
                "question",
                "type (four digits), hands, symmetry, change of hands (Fig. 10) or distance",
            ),
            text("outliers", "none (the rule finds none), kept or left out"),
            text("test", "test; `in words`: what follows from the others"),
            text(
                "kind",
                "what it answers: check (of assumptions), difference, pair, equivalence, "
                "sensitivity (of the design), variance, association, share or words",
            ),
            text("comparison", "what is compared with what"),
            text("statistic_name", "F, W, H, t, r, chi squared, SD (s) or difference (s)"),
            Column("statistic", "see statistic_name", "value of the statistic"),
            Column("df1", "", "degrees of freedom, of the numerator"),
            Column("df2", "", "degrees of freedom, of the error"),
            Column("p", "", "p, adjusted for all pairs in post-hoc tests"),
            text(
                "effect_name",
                "kind of the effect size; (partial) eta and omega squared "
                "estimate the same share of variance, and share its interval",
            ),
            Column("effect", "see effect_name", "effect size"),
            Column("effect_low", "see effect_name", "its interval (config: durations.alpha)"),
            Column("effect_high", "see effect_name", "its interval"),
            Column("n", "", "transitions"),
            text("assumptions", "checks of the test's assumptions"),
            Column("power", "", "power of this test at this n, for the effect in power_for"),
            text("power_for", "effect that the power is told for"),
            Column("spread_s", "s", "SD of the true means that the effect stands for"),
            Column("decisive", "", "whether the question is decided by this row"),
            Column(
                "p_holm",
                "",
                "p adjusted (Holm) for all tests that ask the same: whether types matter, or "
                "whether duration goes with distance",
            ),
            NOTE,
        ),
    ),
    Table(
        "duration_coefficients",
        "results/naert2017/<corpus>/duration_coefficients.csv",
        "a coefficient of a duration model (Naert et al. 2017, section 5.2)",
        (
            text("corpus", "corpus"),
            text("model", "LINEAR or SURFACE"),
            text("coefficient", "constant, mean_distance, geodesic or euclidean"),
            text("unit", "unit of the coefficient"),
            text("published", "as printed, empty where the paper prints none"),
            Column("fitted", "see unit", "least squares on the manual transitions"),
            Column("standard_error", "see unit", "its standard error"),
            Column("low", "see unit", "interval by Student's t (config: durations.alpha)"),
            Column("high", "see unit", "interval by Student's t"),
            Column("bootstrap_low", "see unit", "bootstrap interval"),
            Column("bootstrap_high", "see unit", "bootstrap interval"),
            text("published_inside", "yes or no: whether both intervals hold the printed one"),
            Column("n", "", "transitions"),
            NOTE,
        ),
    ),
    Table(
        "duration_models",
        "results/naert2017/<corpus>/duration_models.csv",
        "a duration model and how it was tested (Naert et al. 2017, section 5.2)",
        (
            text("corpus", "corpus"),
            text(
                "model",
                "MEAN (baseline), SIMPLE, SIMPLE_BOUNDED, LINEAR, SURFACE or "
                "SURFACE_PRINTED (theta as printed, nothing learnt)",
            ),
            text("evaluation", "in_sample, leave_one_out or leave_one_recording_out"),
            Column("n", "", "transitions, the same for all models of a corpus"),
            Column("mean_error_s", "s", "mean absolute error (eq. 5)"),
            Column("mean_error_low_s", "s", "its bootstrap interval"),
            Column("mean_error_high_s", "s", "its bootstrap interval"),
            Column("gain_s", "s", "mean error of MEAN in the same evaluation less this one's"),
            Column("gain_low_s", "s", "its bootstrap interval (paired)"),
            Column("gain_high_s", "s", "its bootstrap interval (paired)"),
            Column("rmse_s", "s", "root of the mean squared error"),
            Column("bias_s", "s", "mean of predicted - true; above 0: too long"),
            Column("bias_low_s", "s", "its bootstrap interval"),
            Column("bias_high_s", "s", "its bootstrap interval"),
            Column("share_too_long", "", "share predicted too long; 0.5 is chance"),
            Column("share_too_long_low", "", "its bootstrap interval"),
            Column("share_too_long_high", "", "its bootstrap interval"),
            Column("longest_s", "s", "longest prediction"),
            Column("share_above_bound", "", "share predicted longer than durations.highest_s"),
            NOTE,
        ),
    ),
    Table(
        "duration_predictions",
        "results/naert2017/<corpus>/fig_durations.csv",
        "a transition as a duration model predicts it when it learnt from all others",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            text("model", "as in duration_models"),
            Column("duration_s", "s", "duration between manual tags"),
            Column("predicted_s", "s", "prediction, leave-one-out"),
        ),
    ),
    Table(
        "surface_points",
        "results/naert2017/<corpus>/fig11.csv",
        "a transition and the fitted surface at its distances (Naert et al. 2017, Fig. 11)",
        (
            *LEAD,
            Column("transition", "", "place of the transition in its recording, from 1"),
            Column("geodesic_rad", "rad", "eq. 1, mean over joints"),
            Column("euclidean_units", "euclidean_unit_m", "eq. 2, mean over joints"),
            Column("duration_s", "s", "duration between manual tags"),
            Column("surface_s", "s", "surface there, in sample; empty without a surface"),
        ),
    ),
    Table(
        "surface",
        "results/naert2017/<corpus>/surface.csv",
        "a coefficient of the duration surface (Naert et al. 2017, section 5.2, eq. 4)",
        (
            text("corpus", "corpus"),
            text("coefficient", "constant, geodesic or euclidean"),
            text("published", "theta as printed"),
            Column("fitted", "s, s/rad, s/unit", "least squares on the manual transitions"),
            Column("low", "same", "95 % interval, low"),
            Column("high", "same", "95 % interval, high"),
            Column("designed", "same", "fit on the distances a simulation was designed with"),
            Column("shift_percent", "%", "fitted against published"),
            Column("n", "", "transitions"),
            Column("mean_error_s", "s", "eq. 5 of the fit"),
        ),
    ),
)
