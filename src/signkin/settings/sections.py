"""config.yaml as typed, frozen sections: each key's default, unit, limits and place in the papers.

The comments of config.yaml, its JSON Schema and docs/configuration.md are made from these models
(`python -m signkin.settings`); a test compares them. Checks across keys stand in `checks.py`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from signkin.settings.base import Hertz, Order, Positive, Section, Share, address, each_once, key

Grid = Annotated[tuple[Positive, ...], Field(min_length=1, strict=False), AfterValidator(each_once)]
Shares = Annotated[tuple[Share, ...], Field(min_length=1, strict=False), AfterValidator(each_once)]
Orders = Annotated[tuple[Order, ...], Field(min_length=1, strict=False), AfterValidator(each_once)]
Names = Annotated[tuple[str, ...], Field(min_length=1, strict=False)]
Degrees = Annotated[
    tuple[Annotated[float, Field(gt=0, le=1e9)] | None, ...],
    Field(strict=False), AfterValidator(each_once),
]  # fmt: skip
Draws = Annotated[int, Field(ge=100, le=1_000_000)]
TimeUnit = Literal["bin", "second", "trajectory"]
LengthUnit = Literal["mm", "cm", "m"]
DurationRule = Literal["simple", "simple_bounded", "linear", "surface"]


class Lowpass(Section):
    """A low-pass filter without delay."""

    method: Literal["butterworth", "fir"] = key(
        "butterworth", "`butterworth`, run in both directions, or `fir`, as in Endres et al. 2.2.",
        paper='Naert 4.1: "a lowpass filter", no type',
    )  # fmt: skip
    cutoff_hz: Hertz = key(
        6.0, "Half gain (-6 dB); below half the rate of every recording.", unit="Hz",
        paper="Naert 4.1 gives none",
    )  # fmt: skip
    order: int = key(2, "Of the Butterworth filter.", ge=1, le=8)


class BinningLowpass(Section):
    """The filter before binning."""

    method: Literal["butterworth", "fir"] = key(
        "fir", "`fir` (made of an odd number of taps, its design frequency solved for) or "
        "`butterworth`.", paper="Endres 2.2: 50-sample FIR",
    )  # fmt: skip
    cutoff_hz: Hertz = key(6.0, "Half gain (-6 dB).", unit="Hz", paper="Endres 2.2: 6 Hz")
    order: int = key(2, "Of the Butterworth filter.", ge=1, le=8)


class Minima(Section):
    """Minima of wrist speed; Naert 4.1 gives neither number."""

    prominence: Share = key(
        0.05, "Depth below the surroundings, as a share of the 95th percentile of the speed of the "
        "recording's faster hand.", paper="Naert 4.1 gives none",
    )  # fmt: skip
    spacing_s: float = key(0.05, "Least distance between two minima.", unit="s", ge=0)


class Kinematics(Section):
    """Canonical recordings to wrist paths, speeds and minima."""

    longest_gap_s: float = key(
        0.2, "Gaps up to this long are filled; longer ones stay gaps and are counted.", unit="s",
        ge=0,
    )  # fmt: skip
    most_missing: Share = key(
        0.2, "A wrist may miss at most this share of the frames after filling; more is an error."
    )
    lowpass: Lowpass = Lowpass()
    minima: Minima = Minima()


class Refinement(Section):
    """Manual tags moved to minima of wrist speed (Naert 4.2)."""

    search_window_s: Positive = key(
        0.15, "How far from a tag a minimum is looked for, either way.", unit="s",
        paper="Naert 4.2: 15 frames at 100 Hz",
    )  # fmt: skip
    tolerance_s: float = key(
        1e-6, "Floating point: a minimum this much outside the window still counts.", unit="s",
        ge=0, le=0.01,
    )  # fmt: skip
    draws: Draws = key(1000, "Sets of random tags for the chance baseline, and bootstrap draws.")


class Transitions(Section):
    """Durations and posture distances of transitions (Naert 5)."""

    euclidean_unit_m: Positive = key(
        0.1, "Unit of the Euclidean distance in the duration models. The paper prints 1.08 as a "
        "mean over joints, which cannot be metres.", unit="m", paper="Naert 5.2",
    )  # fmt: skip
    geodesic_frame: Literal["world", "parent"] = key(
        "world", "Orientations in the `world`, or relative to the `parent` joint (where the "
        "recording has a hierarchy).", paper="Naert eq. 1",
    )  # fmt: skip
    outlier_iqr: Positive = key(
        3.0, "Outliers: more than this many interquartile ranges outside the quartiles of all "
        "durations.",
    )  # fmt: skip
    diamond_share: Share = key(
        0.9, "The diamond holds more than this share of the transitions.", paper="Naert Fig. 8"
    )


class SignTypes(Section):
    """A sign's type from its motion, for glosses that signs.csv does not have."""

    activity: Share = key(
        0.4, "Paths of the wrists (relative to the shoulders, where there are some), the shorter "
        "over the longer: below this, one-handed.",
    )  # fmt: skip
    mirror: float = key(
        0.5, "Correlation of the wrists' velocities, one mirrored: from this on, symmetric.",
        ge=-1, le=1,
    )  # fmt: skip
    held_shift: float = key(
        0.08, "A still hand that moved less than this since the sign before is held.",
        unit="arm lengths", ge=0,
    )  # fmt: skip
    held_height: Share = key(0.35, "And stands above this share of its range of heights.")


class Utterance(Section):
    """An utterance that a run makes."""

    corpus: str = key(text="A corpus; one that is not in the run is passed over.", min_length=1)
    name: str = key(text="Of its files.", pattern=r"^[A-Za-z0-9._-]+$", max_length=60)
    glosses: Names = key(text="Glosses in order.")


class Synthesis(Section):
    """Transitions and utterances made from captured signs (Naert 3.1)."""

    orientations: Literal["slerp", "linear"] = key(
        "slerp", "Orientations between two postures by `slerp`, or `linear` as in the paper.",
        paper="Naert 3.1",
    )  # fmt: skip
    keep_limbs: bool = key(
        True, "Recordings without recorded orientations: give limbs their length back after mixing "
        "positions.",
    )  # fmt: skip
    align_takes: bool = key(
        True, "Takes are turned and shifted to where the signer of the first one stands."
    )
    method: Literal["interpolation", "blending"] = key(
        "blending", "How utterances and Fig. 1 and 2 are made."
    )
    duration: DurationRule = key("surface", "Which rule gives their transitions a duration.")
    retrieval: Literal["chain", "greedy", "first"] = key(
        "chain", "Choice among the signs of a gloss: `chain` (least distance over the whole "
        "sequence), `greedy` (each the nearest to the one before), or `first` (none).",
    )  # fmt: skip
    found_raised: Share = key(
        0.35, "Takes without tags: their sign lies between two rest parts, while the higher wrist "
        "is above this share of its range of heights.",
    )  # fmt: skip
    found_still: Share = key(
        0.2, "It starts and ends where that wrist's speed falls below this share of the raising's "
        "and the lowering's peak.",
    )  # fmt: skip
    utterances: Annotated[tuple[Utterance, ...], Field(strict=False)] = key(
        (
            Utterance(corpus="dgs-1984189", name="example",
                      glosses=("$INDEX1", "CAT3", "BIRD1", "BINOCULARS1*")),
            Utterance(corpus="boston104", name="example", glosses=("JOHN", "BUY", "HOUSE")),
            Utterance(corpus="libras", name="example", glosses=("BOCA", "ENTENDER")),
            Utterance(corpus="lsf-sim", name="example",
                      glosses=("ONE-07", "TWO-07", "TWO-SYM-05", "ONE-CONTEXT-03")),
        ),
        'Utterances that a run makes (others: make utterance CORPUS=... GLOSSES="...").',
    )  # fmt: skip


class Durations(Section):
    """Statistics and models of durations (Naert 5)."""

    simple_alpha: Share = key(
        0.5, "SIMPLE_DURATION: weight of the Euclidean part.", paper="Naert eq. 3 prints none"
    )
    simple_angle: Literal["half", "full"] = key(
        "half", "Its angular velocities: `half` the angle a second, as eq. 1 measures angles, or "
        "the `full` one.", paper="Naert eq. 3",
    )  # fmt: skip
    lowest_s: float = key(
        0.1, "SIMPLE_BOUNDED_DURATION: no shorter.", unit="s", ge=0, paper="Naert 5.2"
    )
    highest_s: Positive = key(
        0.5, "SIMPLE_BOUNDED_DURATION: no longer.", unit="s", paper="Naert 5.2"
    )
    alpha: float = key(0.05, "Level of all tests; intervals hold 1 - alpha.", ge=1e-6, le=0.5)
    power: float = key(0.8, "Smallest effects are those that this power finds.", ge=0.5, lt=1)
    effect_f: Positive = key(0.25, "Power is told for this effect.", unit="Cohen's f")
    equivalence_s: Positive = key(
        0.05, "Equivalence: two mean durations closer than this count as the same.", unit="s",
        paper="Naert 5.1 has no bound",
    )  # fmt: skip
    draws: Draws = key(1000, "Bootstrap draws.")
    bootstrap_recordings: int = key(
        20, "From so many recordings on, recordings are drawn, not single transitions.",
        ge=2, le=1_000_000,
    )  # fmt: skip


class PowerLaw(Section):
    """Ground truth with known boundaries (Endres 2.4): fields of signkin.powerlaw.WarpSettings."""

    active_share: Share = key(
        0.15, "The ends of a movement below this share of its top speed are left out.",
        paper="Endres 2.4: 15 %",
    )  # fmt: skip
    segments: int = key(3, "Number of segments.", ge=2, le=50, paper="Endres 2.4: 3")
    least_segment_s: Positive = key(
        0.3, "Their least duration before and after warping.", unit="s", paper="Endres 2.4: 300 ms"
    )
    least_exponent: float = key(
        -1.0, "Least exponent beta.", ge=-2, le=1, paper="Endres 2.4: [-1, 0]"
    )
    most_exponent: float = key(
        0.0, "Greatest exponent beta.", ge=-2, le=1, paper="Endres 2.4: [-1, 0]"
    )
    least_exponent_step: float = key(
        0.1, "How far neighbours' exponents are apart.", ge=0, le=3, paper="Endres 2.4: 0.1"
    )
    first_gain: Literal["duration", "first_sample"] = key(
        "duration", "Gain of the first segment: from the `duration` of the whole, which stays, or "
        "from speed and curvature at the `first_sample`.", paper="Endres 2.4 prints first_sample",
    )  # fmt: skip
    most_speed_ratio: float = key(
        2.0, "Top speed of each segment within this factor of the recorded one, either way.", gt=1,
        paper='Endres 2.4: "improbable high speed ratios", no number',
    )  # fmt: skip
    most_duration_ratio: float = key(
        2.0, "Duration of each segment within this factor of the recorded one, either way.", gt=1,
        paper='Endres 2.4: "comparable", no number',
    )  # fmt: skip
    straight_turn_rad: Positive = key(
        0.05, "A path that turns by less than this on its whole length is straight; curvatures "
        "below that are warped as if they were that.", unit="rad", paper="not in the paper",
    )  # fmt: skip
    least_r_squared: float = key(
        0.97, "R squared of the laws fitted again to speed and curvature of the samples.", le=1,
        paper="Endres Fig. 1: above 0.97",
    )  # fmt: skip
    most_draws: int = key(3000, "Draws before a trajectory is left out.", ge=1, le=10_000_000)
    output_rate_hz: Annotated[float, Field(ge=15, le=100_000)] | None = key(
        240.0, "Sampling rate of the warped movement; null: that of the recording.", unit="Hz",
        paper="Endres 2.2: 240 Hz",
    )  # fmt: skip


class Prior(Section):
    """The prior over a segment's polynomial and noise (Endres 2.5.5, 3.2)."""

    noise: Literal["sensor", "data"] = key(
        "sensor", "`sensor`: the corpus's noise_sd. `data`: the data's own variances, as the paper "
        "prints, which finds almost no boundaries unless scale is literal.", paper="Endres 3.2",
    )  # fmt: skip
    dof: Annotated[float, Field(gt=1, le=1e9)] | None = key(  # positions have 2 or 3 dimensions
        None, "Degrees of freedom of the Wishart density; null: the number of dimensions.",
        paper="Endres prints none",
    )  # fmt: skip
    scale: Literal["expected", "plain", "literal"] = key(
        "expected", "`expected`: V^-1 = dof times the variance, `plain`: the variance. `literal`: "
        "V itself, a precision, is the data's variance, in the unit of length_unit.",
        paper="Endres 2.5.5: V the scale matrix of the Wishart density",
    )  # fmt: skip
    length_unit: LengthUnit | None = key(
        None, "Unit of length of V's numbers; mandatory with `literal`, and null without.",
        paper="Endres prints none",
    )  # fmt: skip
    concentration: float = key(
        0.1, "B = concentration times I.", ge=1e-12, le=1e12, paper="Endres 3.2: 0.1"
    )
    time_unit: TimeUnit = key("bin", "Unit of the polynomials' time.", paper="Endres prints none")


class Continuous(Section):
    """Continuous recordings as long series."""

    bin_s: Positive = key(0.02, "Duration of a bin (or the recording's own, if longer).", unit="s")
    longest_segment_s: Positive = key(2.0, "Longest segment.", unit="s")
    order: Order = key(3, "Order of the polynomials.")


class Binning(Section):
    """Bayesian binning of wrist trajectories (Endres 2.5, 3)."""

    lowpass: BinningLowpass = BinningLowpass()
    bins: int = key(
        100, "Bins T of a trajectory; as many as samples where there are fewer samples.",
        ge=2, le=10_000, paper="Endres 3.2: 100",
    )  # fmt: skip
    orders: Orders = key(
        (0, 1, 2, 3, 4, 5, 6, 7), "Polynomial orders S.", paper="Endres 3.2: 0 to 7"
    )
    prior: Prior = Prior()
    hit_window_s: Positive = key(
        0.09, "Half-width of the window of a hit.", unit="s", paper="Endres 3.1: 90 ms"
    )
    fitted_orders: Orders = key(
        (1, 2, 3, 4, 5, 6, 7), "Fitted trajectories as data: orders they are made with.",
        paper="Endres 3.1, A.1",
    )  # fmt: skip
    fitted_recordings: int = key(
        80, "How many of a corpus's recordings they are made of, at most.", ge=1
    )
    recovery_noise: float = key(
        0.1, "The prior's noise for them, as a share of the sensor's, which is not in them. With "
        "prior.noise `data` nothing is taken off: the variances are their own.",
        gt=0, le=1000,
    )  # fmt: skip
    bootstrap_draws: Draws = key(2000, "Draws of the bootstrap.")
    chance_trajectories: Draws = key(
        4000, "Trajectories thrown at for each point of the chance lines."
    )
    continuous: Continuous = Continuous()


class NaertChoices(Section):
    """What Naert et al.'s claims rest on: every combination is run (audit of N05, N12, N19-N21)."""

    cutoff_hz: Grid = key(
        (4.0, 6.0, 8.0, 10.0), "Cut-off of the low-pass.", unit="Hz", paper="Naert 4.1 gives none"
    )
    prominence: Shares = key(
        (0.02, 0.05, 0.1), "Least depth of a minimum, as kinematics.minima.prominence.",
        paper="Naert 4.1 gives none",
    )  # fmt: skip
    search_window_s: Grid = key(
        (0.10, 0.15, 0.20), "How far from a tag a minimum is looked for.", unit="s",
        paper="Naert 4.2: 0.15",
    )  # fmt: skip
    draws: Draws = key(200, "Sets of random tags for the chance baseline of each combination.")


class EndresChoices(Section):
    """What Endres et al. do not print decides their results: all combinations are run.

    beside: the prior that Fig. 3 to 7 are shown with once more, beside binning.prior.
    """

    recordings: int = key(8, "On so many recordings of each corpus.", ge=1)
    learnt_recordings: int = key(
        24, "The prior is learnt on half of so many recordings, and the other half predicted.", ge=4
    )
    orders: Orders = key((0, 1, 2, 3, 4, 5, 6, 7), "Polynomial orders S.")
    dof: Annotated[Degrees, Field(min_length=1)] = key((None, 5, 30, 1000), "As binning.prior.dof.")
    noise: Annotated[
        tuple[Literal["sensor expected", "sensor plain", "data expected", "data plain"], ...],
        Field(min_length=1, strict=False), AfterValidator(each_once),
    ] = key(
        ("sensor expected", "sensor plain", "data expected", "data plain"),
        "binning.prior.noise and binning.prior.scale.",
    )  # fmt: skip
    concentration: Grid = key((0.001, 0.1, 10.0), "As binning.prior.concentration.")
    literal_dof: Degrees = key(
        (None, 3.5, 4, 5, 10), "As binning.prior.dof, with the data's variances as V itself "
        "(binning.prior.scale: literal); [] leaves this reading out.", paper="Endres 2.5.5, 3.2",
    )  # fmt: skip
    literal_unit: Annotated[
        tuple[LengthUnit, ...], Field(min_length=1, strict=False), AfterValidator(each_once)
    ] = key(("mm", "cm", "m"), "And as binning.prior.length_unit.")
    time_unit: Annotated[
        tuple[TimeUnit, ...], Field(min_length=1, strict=False), AfterValidator(each_once)
    ] = key(("bin", "second", "trajectory"), "As binning.prior.time_unit.")
    bins: Annotated[
        tuple[Annotated[int, Field(ge=10, le=10_000)], ...],
        Field(min_length=1, strict=False), AfterValidator(each_once),
    ] = key((50, 100), "As binning.bins.")  # fmt: skip
    beside: Prior = Prior(noise="data", scale="literal", length_unit="mm")


class IslSim(Section):
    """The simulated corpus isl-sim: fields of signkin.simulate.isl.Recipe."""

    order: Literal[3, 5, 7] = key(
        5, "Order of its strokes: 3, 5 or 7, of least acceleration, jerk or snap."
    )
    parts: int = key(1, "How many strokes stand for one of the design.", ge=1, le=20)


class Simulation(Section):
    """How the simulated corpora are made."""

    isl: IslSim = IslSim()


class OpenChoices(Section):
    """Choices that the papers leave open, each varied: what the claims rest on."""

    naert2017: NaertChoices = NaertChoices()
    endres2013: EndresChoices = EndresChoices()


class Samples(Section):
    """What is drawn at random, or made anew, is of a seeded sample of a larger corpus's recordings.

    So that such a step costs the same whatever the corpus; each table tells where it is a sample.
    """

    transitions: int = key(
        700, "Recordings are drawn until they hold so many pairs of neighbouring signs: for chance "
        "baselines, the jitter of tags, open choices, excerpts, agreement and synthesis.", ge=2,
    )  # fmt: skip


class Report(Section):
    """The pages of a run."""

    explorer_recordings: Annotated[int, Field(ge=1)] | None = key(
        200, "Recordings of a corpus that get a page of their own, at most: half of them those "
        "with the most to look at, the others spread over the corpus; null: all.",
    )  # fmt: skip


class Settings(Section):
    """The scientific choices of a run."""

    seed: int = key(
        2017, "Random streams are spawned from this one, per corpus, recording and purpose.", ge=0,
        lt=2**63,
    )  # fmt: skip
    data_dir: str | None = key(
        None, "Folder of the real recordings, or an address that a storage plugin of Snakemake "
        "knows (s3://bucket/folder); SIGNKIN_DATA or `make DATA=...` go before it. null: none.",
    )  # fmt: skip
    results_store: Annotated[str, AfterValidator(address)] | None = key(
        None, "Address that a whole run copies its results to (s3://bucket/folder), which is "
        "emptied before; null: they stay in results/ alone.",
    )  # fmt: skip
    corpora: (
        Literal["all"]
        | Annotated[tuple[str, ...], Field(strict=False), AfterValidator(each_once)]
    ) = key("all", "`all`, or a list of folders below corpora_dir.")  # fmt: skip
    corpora_dir: str = key("corpora", "Folder of the descriptions of corpora.", min_length=1)
    papers_dir: str = key("papers", "Folder of the papers' claims and prints.", min_length=1)
    recordings_per_job: int = key(
        1000, "Recordings that share a job: the start-up of a job is about 2 s, a short recording "
        "takes 2 ms.", ge=1,
    )  # fmt: skip
    simulation: Simulation = Simulation()
    kinematics: Kinematics = Kinematics()
    refinement: Refinement = Refinement()
    transitions: Transitions = Transitions()
    sign_types: SignTypes = SignTypes()
    durations: Durations = Durations()
    synthesis: Synthesis = Synthesis()
    powerlaw: PowerLaw = PowerLaw()
    binning: Binning = Binning()
    open_choices: OpenChoices = OpenChoices()
    samples: Samples = Samples()
    report: Report = Report()
