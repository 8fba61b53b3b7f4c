"""Tables of Endres, Meirovitch, Flash & Giese 2013."""

from __future__ import annotations

from signkin.tables.schema import HAND, LEAD, NOTE, Column, Table, text

_DATASET = text("dataset", "recorded, powerlaw, fitted or fitted_map")
_TRUE_ORDER = Column(
    "true_order", "", "order of the polynomials that fitted trajectories were made with"
)
_ORDER = Column("order", "", "polynomial order S")
_SINGLE_SIGN = text("sign", "the recording's sign")
_GROUP = (
    text("corpus", "corpus, as its folder is called"),
    _DATASET,
    _TRUE_ORDER,
    text("signer", "signer, or `all`"),
    text("sign", "sign, or `all`"),
)
_COUNTED = (
    Column("n", "", "trajectories"),
    Column("without_truth", "", "of these, without a true boundary: in no hit rate"),
)

_READING = text("reading", "as configured, or without which rule of ours")

_OWN = (
    Table(
        "ground_truth",
        "results/endres2013/<corpus>/ground_truth.csv",
        "a segment of a power-law ground truth (section 2.4)",
        (
            *LEAD,
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
            *LEAD,
            Column("draws", "", "draws in all"),
            text("reason", "why draws were rejected"),
            Column("rejected", "", "how many, for this reason"),
        ),
    ),
    Table(
        "binning_left_out",
        "results/endres2013/<corpus>/left_out.csv, wrists_left_out.csv, not_cut.csv, "
        "not_binned.csv",
        "a trajectory that was not binned",
        (*LEAD, _DATASET, text("reason", "why it was left out")),
    ),
    Table(
        "binning",
        "results/endres2013/<corpus>/binning.csv",
        "a trajectory and a polynomial order (section 3)",
        (
            *LEAD,
            _SINGLE_SIGN,
            Column("repetition", "", "its number among the repetitions"),
            _DATASET,
            _TRUE_ORDER,
            text("prior_id", "degrees of freedom, noise, scale, concentration, time unit"),
            Column("n_bins", "", "bins T"),
            Column("duration_s", "s", "duration of all bins"),
            _ORDER,
            Column("log_evidence", "", "ln P(D | S), summed over M"),
            Column("order_probability", "", "P(S | D)"),
            Column("map_count", "", "most probable number M of inner boundaries"),
            Column("expected_count", "", "expected number of inner boundaries"),
            Column("cut_mass", "", "bound on the share of P(M | D, S) that was cut off"),
            Column("explained_variance", "", "of the trajectory by its expectation"),
            Column(
                "noise_misfit",
                "",
                "distance from it, RMS, in SDs of the noise that the prior expects: far above 1, "
                "noise_sd is too small; far below, boundaries are lost",
            ),
            text("at_floor", "yes where M is the least that the longest segment allows"),
            Column("hits", "", "true boundaries that were found"),
            Column("misses", "", "true boundaries that were not"),
            Column("false_positives", "", "boundaries found that are none"),
            Column("hit_rate", "", "hits over true boundaries"),
            Column("false_positives_per_s", "1/s", "false positives a second"),
            Column("hpfpps", "s", "hit rate over false positives a second (eq. 17)"),
            NOTE,
        ),
    ),
    Table(
        "fitted_truths",
        "results/endres2013/<corpus>/fitted_truths.csv",
        "a boundary of a fitted trajectory, which binning is to find again",
        (
            *LEAD,
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
            NOTE,
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
            text("corpus", "corpus, as its folder is called"),
            text("question", "what is asked"),
            text("test", "Kruskal-Wallis, or Friedman with the trajectory as a block"),
            Column("statistic", "", "H or chi squared"),
            Column("df", "", "degrees of freedom"),
            Column("p", "", "p, of ranks; hits without a false positive are a tied top"),
            Column("n", "", "values, or blocks"),
            Column("left_out", "", "values or blocks with neither hit nor false positive"),
            Column("without_truth", "", "trajectories without a true boundary"),
            NOTE,
        ),
    ),
    Table(
        "fig01_powerlaw",
        "results/endres2013/<corpus>/fig01.csv",
        "a sample of the recording drawn in Fig. 1, recorded or warped",
        (
            *LEAD,
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
        "results/endres2013/<corpus>/fig03.csv, fig04.csv, fig05.csv, fig06.csv, fig07.csv, "
        "figA1.csv, fig_one_wrist.csv",
        "a point drawn in a figure",
        (
            text("corpus", "corpus, as its folder is called"),
            text("panel", "panel, as in the figure"),
            text("series", "line or kind of mark"),
            Column("x", "", "as the panel's horizontal axis says"),
            Column("y", "", "as the panel's vertical axis says; 0 where a line stands at x"),
            Column("x_error", "", "standard error of x, where drawn"),
            Column("y_error", "", "standard error (Fig. 3D: deviation) of y, where drawn"),
            text("label", "what is written beside it"),
        ),
    ),
    Table(
        "order_choices",
        "results/endres2013/<corpus>/order_choices.csv",
        "a setting of what the paper does not print, and its results on some recordings",
        (
            text("corpus", "corpus, as its folder is called"),
            text("dof", "degrees of freedom of the prior; L: number of dimensions"),
            text("noise", "sensor or data; expected, plain or literal scale, and its unit"),
            Column("concentration", "", "b"),
            text("time_unit", "bin, second or trajectory"),
            Column("bins", "", "T"),
            text("printed", "yes where it agrees with all that section 3.2 prints"),
            text("default", "yes where it is the setting of config.yaml"),
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
            text("hpfpps_peak", "orders with the highest pooled ratio"),
            Column("recovered_probability", "", "fitted_map of order 3: mean P(S = 3 | D)"),
            Column("recovered_hit_rate", "", "fitted_map of order 3, binned with order 3"),
            Column("recordings", "", "recordings that were run"),
            NOTE,
        ),
    ),
    Table(
        "recorded_laws",
        "results/endres2013/<corpus>/recorded_laws.csv",
        "a segment of a recorded movement, between boundaries of order 3, and its power law (2.3)",
        (
            *LEAD,
            _SINGLE_SIGN,
            Column("segment", "", "place of the segment, from 1"),
            Column("start_s", "s", "its start, from that of the movement"),
            Column("end_s", "s", "its end"),
            Column("n", "", "samples with a curvature"),
            Column("beta", "", "exponent by non-linear regression, as in the paper"),
            Column("log_beta", "", "exponent by the line through the logarithms"),
            Column("both_beta", "", "exponent by that line with errors in both (Deming)"),
            Column("r", "", "correlation of the logarithms of speed and curvature"),
            Column("r_squared", "", "R squared of the non-linear fit (eq. 5)"),
            NOTE,
        ),
    ),
    Table(
        "law_pitfalls",
        "results/endres2013/<corpus>/law_pitfalls.csv",
        "exponents found on a path of known exponent through the corpus's filter, rate and noise",
        (
            text("corpus", "corpus, as its folder is called"),
            text("path", "ellipse (half axes of 0.10 and 0.05 m), or noise alone"),
            Column("beta", "", "its exponent; empty for noise alone"),
            Column("duration_s", "s", "of one turn, from which the exponent is found"),
            Column("noise_sd", "m or px", "noise before the filter"),
            text("estimator", "non-linear, logarithms, or errors in both"),
            Column("found", "", "exponent found, mean over draws"),
            Column("sd", "", "its SD over draws; empty without noise"),
            Column("r", "", "correlation of the logarithms, mean over draws"),
            Column("smallest_difference", "", "of two exponents, told with a power of 0.8"),
            Column("draws", "", "draws of noise"),
        ),
    ),
    Table(
        "learnt_prior",
        "results/endres2013/<corpus>/learnt_prior.csv",
        "a prior, and how well it predicts the half of the recordings that is held out",
        (
            text("corpus", "corpus, as its folder is called"),
            text("held_out", "which half is predicted; the prior is learnt on the other one"),
            text("prior", "learnt, or its name, as prior_id in binning"),
            Column("dof", "", "degrees of freedom nu"),
            Column(
                "noise_sd_{u}",
                "m or px",
                "noise expected, geometric mean over dimensions; "
                "median over trajectories where each has its own",
            ),
            Column("concentration", "", "b"),
            Column("order", "", "most probable order, shared by the other half"),
            Column("order_probability", "", "its probability there"),
            Column("log_density_train", "", "nats a coordinate and bin, other half"),
            Column("log_density_held_out", "", "nats a coordinate and bin, predicted"),
            Column("gain", "", "nats a held-out trajectory over the prior of config.yaml, mean"),
            Column("gain_se", "", "its standard error"),
            Column("n_train", "", "trajectories of the other half"),
            Column("n_held_out", "", "trajectories held out"),
            Column("evaluations", "", "evidences worked out in search of it"),
            NOTE,
        ),
    ),
    Table(
        "two_priors",
        "results/endres2013/<corpus>/two_priors.csv",
        "a reading of the prior, a group of trajectories and an order (Fig. 3 to 7)",
        (
            text("corpus", "corpus, as its folder is called"),
            text("reading", "as configured, or beside: open_choices.endres2013.beside"),
            text("prior", "its name, as prior_id in binning"),
            _DATASET,
            _TRUE_ORDER,
            _ORDER,
            Column("mean_probability", "", "mean of P(S | D) over trajectories"),
            Column("se", "", "its standard error"),
            Column("mean_count", "", "mean of the most probable M"),
            Column("mean_explained_variance", "", "mean of the explained variance"),
            Column("median_noise_misfit", "", "median of noise_misfit (table binning)"),
            Column("hit_rate", "", "mean over trajectories"),
            Column("hit_rate_se", "", "its standard error"),
            Column("false_positives_per_s", "1/s", "mean over trajectories"),
            Column("false_positives_per_s_se", "1/s", "its standard error"),
            Column("hpfpps", "s", "pooled hit rate over pooled false positives a second"),
            Column("n", "", "trajectories"),
        ),
    ),
    Table(
        "wrist_boundaries",
        "results/endres2013/<corpus>/wrist_boundaries.csv",
        "a boundary that binning finds in a continuous recording",
        (
            *LEAD,
            HAND,
            Column("boundary_s", "s", "its time"),
            Column("probability", "", "posterior of a boundary at most 3 bins away"),
        ),
    ),
    Table(
        "wrist_posteriors",
        "results/endres2013/<corpus>/wrist_posteriors.csv",
        "a wrist of a continuous recording, as a long series",
        (
            *LEAD,
            HAND,
            Column("n_bins", "", "bins T"),
            Column("bin_s", "s", "duration of a bin"),
            _ORDER,
            Column("map_count", "", "most probable number M of inner boundaries"),
            Column("boundaries_per_s", "1/s", "boundaries found, a second"),
            Column("cut_mass", "", "bound on the share of P(M | D, S) that was cut off"),
            Column("explained_variance", "", "of the wrist's path by its expectation"),
            Column("noise_misfit", "", "as in binning"),
            text("at_floor", "yes where M is the least that the longest segment allows"),
            NOTE,
        ),
    ),
    Table(
        "one_wrist",
        "results/endres2013/<corpus>/one_wrist.csv",
        "boundaries by binning against what the other study finds on the same wrist",
        (
            text("corpus", "corpus, as its folder is called"),
            HAND,
            text("found", "what is looked at: boundaries, minima or tags"),
            text("truth", "against what: minima, tags or refined tags"),
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
            NOTE,
        ),
    ),
)


def _as_read(name: str) -> Table:
    """Return a table of the study once more, with the reading that its rows were made under."""
    of = next(table for table in _OWN if table.name == name)
    path = f"results/endres2013/<corpus>/readings_{name}.csv"
    row = f"{of.row}; under a reading as printed"
    return Table(f"readings_{name}", path, row, (_READING, *of.columns))


_EQUAL = Table(
    "equal_bins",
    "results/endres2013/<corpus>/equal_bins.csv",
    "a recorded trajectory, or its ground truth in as many bins, and a polynomial order",
    next(table for table in _OWN if table.name == "binning").columns,
)
TABLES = (
    *_OWN,
    _EQUAL,
    *map(_as_read, ("binning", "hit_rates", "order_posteriors", "ground_truth")),
)
