"""Statistics and models of transition duration for one corpus (Naert et al. 2017, 5.1, 5.2)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from signkin import seeds, tables
from signkin.coarticulation.duration import (
    LINEAR_TERMS,
    TERMS,
    DurationModel,
    LinearDuration,
    MeanDuration,
    SimpleBoundedDuration,
    SimpleDuration,
    SurfaceDuration,
    Transitions,
    predict_left_out,
)
from signkin.errors import SignkinError
from signkin.statistics import anova, association, equivalence, mixed, posthoc, power
from signkin.statistics.descriptive import hand_change, outliers
from signkin.statistics.findings import Finding, grouped, p_text, table, untestable
from signkin.studies.naert2017.distances import with_flags
from signkin.studies.naert2017.transitions import counted

IN_WORDS = "in words"
CHANGE = "change of hands"
NO_TYPE = "no sign has a type"


# --- 5.1: do durations differ by the type of the signs? ---------------------------------------


def statistics(
    corpus: str, transitions: pd.DataFrame, unit: str, settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """Return the table `statistics`. settings: config.yaml (transitions, durations)."""
    rows = counted(transitions)
    typed = rows[rows["type"] != ""]
    chosen = settings["durations"]
    parts = []
    for label, kept in _with_and_without_outliers(typed, settings["transitions"]["outlier_iqr"]):
        for question, findings in _type_questions(kept, chosen).items():
            told = [*findings, _in_words(question, findings, kept, chosen)]
            parts.append(_rows(corpus, question, label, told))
    rng = seeds.stream(seed, corpus, "correlations")
    parts.append(_rows(corpus, "distance", "kept", _distances(transitions, unit, settings, rng)))
    return pd.concat(parts, ignore_index=True)[tables.TABLES["statistics"].names()]


def _rows(corpus: str, question: str, label: str, findings: Iterable[Finding]) -> pd.DataFrame:
    frame = table(findings)
    for place, (column, value) in enumerate(
        {"corpus": corpus, "question": question, "outliers": label}.items()
    ):
        frame.insert(place, column, value)
    return frame


def _with_and_without_outliers(
    rows: pd.DataFrame, fences_iqr: float
) -> Iterator[tuple[str, pd.DataFrame]]:
    flags = outliers(rows["duration_s"].to_numpy(dtype=float), fences_iqr)
    yield ("kept" if flags.any() else "none"), rows
    if flags.any():
        yield "left out", rows[~flags]


def _type_questions(rows: pd.DataFrame, chosen: Mapping[str, Any]) -> dict[str, list[Finding]]:
    """Return the findings of each question about types."""
    n = len(rows)
    if not n:
        return {q: [untestable("one-way ANOVA", q, 0, NO_TYPE)] for q in ("type", CHANGE)}
    durations = rows["duration_s"].to_numpy(dtype=float)
    alpha, bound = chosen["alpha"], chosen["equivalence_s"]
    digits = [rows["type"].str[i].to_numpy(dtype=object) for i in range(4)]
    changes = rows["type"].map(hand_change)
    return {
        "type": _question("type", durations, rows, rows["type"], chosen),
        CHANGE: [
            *_question(CHANGE, durations, rows, changes, chosen),
            *_smallest_differences(grouped(durations, changes), CHANGE, chosen),
            *equivalence.tost_pairs(grouped(durations, changes), CHANGE, bound, alpha),
        ],
        "hands": _factors("hands", durations, digits[0], digits[2], chosen),
        "symmetry": _factors("symmetry", durations, digits[1], digits[3], chosen),
    }


def _question(
    name: str,
    durations: np.ndarray,
    rows: pd.DataFrame,
    labels: pd.Series,
    chosen: Mapping[str, Any],
) -> list[Finding]:
    groups = grouped(durations, labels)
    alpha = chosen["alpha"]
    data = rows[["duration_s", "signer", "recording"]].assign(group=labels)
    return [
        *anova.one_way(groups, name, alpha, chosen["effect_f"]),
        *mixed.mixed_model(data, name),
        *posthoc.pairwise(groups, name, alpha),
        *power.sensitivity(groups, name, alpha, chosen["power"]),
        equivalence.omnibus(groups, name, chosen["equivalence_s"], alpha),
    ]


def _smallest_differences(
    groups: Mapping[str, np.ndarray], name: str, chosen: Mapping[str, Any]
) -> list[Finding]:
    labels = list(groups)
    return [
        power.sensitivity_of_two(
            groups[a], groups[b], f"{name}: {a} - {b}", chosen["alpha"], chosen["power"]
        )
        for i, a in enumerate(labels)
        for b in labels[i + 1 :]
    ]


def _factors(
    name: str,
    durations: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    chosen: Mapping[str, Any],
) -> list[Finding]:
    alpha, bound = chosen["alpha"], chosen["equivalence_s"]
    out = anova.factorial(
        durations, before, after, (f"{name} before", f"{name} after"), alpha, chosen["effect_f"]
    )
    for side, digit in (("before", before), ("after", after)):
        if name == "hands":  # as in Fig. 10, type 2 is two-handed
            labels = np.where(digit == "0", "one", "two")
        else:
            labels = np.where(digit == "0", "asymmetric", "symmetric")
        groups = grouped(durations, labels)
        out += _smallest_differences(groups, f"{name} {side}", chosen)
        out += equivalence.tost_pairs(groups, f"{name} {side}", bound, alpha)
    return out


def _in_words(
    question: str, findings: list[Finding], rows: pd.DataFrame, chosen: Mapping[str, Any]
) -> Finding:
    """Say what follows: a difference, equivalence, or neither."""
    alpha, bound = chosen["alpha"], chosen["equivalence_s"]
    tests = [f for f in findings if _decides(question, f)]
    title = question if question in ("type", CHANGE) else f"{question} before x {question} after"
    if not tests:
        return Finding(IN_WORDS, title, n=len(rows), note="nothing can be tested: see the reasons")
    found = [f for f in tests if f.p < alpha]
    same, excluded = _equivalence(question, findings, alpha, bound)
    smallest = _smallest(findings)
    others = _others(findings, bool(found), alpha)
    none = "No difference was found" if not others else "The deciding test finds no difference"
    if found:
        told = "; ".join(
            f"{f.comparison}: {f.test} F({f.df1:g}, {f.df2:.4g}) = {f.statistic:.2f}, "
            f"{p_text(f.p)}, {f.effect_name} {f.effect:.3f} ({f.effect_low:.3f} to "
            f"{f.effect_high:.3f})"
            for f in found
        )
        start = "The deciding test finds a difference" if others else "Durations differ"
        text = f"{start}. {told}."
        if same:
            text += f" The difference is small: {excluded}."
    elif same:
        text = f"{none}, and {excluded}."
    else:
        text = (
            f"{none}, which is no evidence that there is none: equivalence within "
            f"± {bound:g} s was not shown either. {smallest}"
        )
    text += others
    checks = next((f.assumptions for f in findings if f.assumptions), "")
    sources = rows["type_source"].value_counts()
    if sources.get("kinematic", 0):
        text += (
            f" {sources['kinematic']} of {len(rows)} types are inferred from motion, a stand-in "
            "for what a signer knows."
        )
    return Finding(IN_WORDS, title, n=len(rows), assumptions=checks, note=text)


def _others(findings: list[Finding], found: bool, alpha: float) -> str:
    """Name the tests of the same question that come out the other way."""
    names = ("one-way ANOVA", "Kruskal-Wallis", mixed.TEST)
    against = {f.test: f.p for f in findings if f.test in names and (f.p < alpha) != found}
    told = [f"{test} {p_text(p)}" for test, p in against.items() if np.isfinite(p)]
    return f" Others say otherwise: {', '.join(told)}." if told else ""


def _decides(question: str, finding: Finding) -> bool:
    """Tell the tests that decide: Welch's, which wants no equal variances; type II for factors."""
    wanted = "Welch's ANOVA" if question in ("type", CHANGE) else "factorial ANOVA, type II"
    return (
        finding.test == wanted
        and np.isfinite(finding.p)
        and finding.effect_name.endswith("eta squared")
        and "omega" not in finding.effect_name
    )


def _equivalence(
    question: str, findings: list[Finding], alpha: float, bound: float
) -> tuple[bool, str]:
    if question == "type":
        tests = [f for f in findings if f.test == equivalence.OMNIBUS]
        text = (
            f"the types' true means scatter with an SD below {bound / 2:g} s, though one type may "
            "lie farther off"
        )
    elif question == CHANGE:
        title = f"{CHANGE}: {equivalence.ALL_PAIRS}"
        every = [f for f in findings if f.test == equivalence.TOST]
        tests = [f for f in every if f.comparison == title] or every
        text = f"all means lie within ± {bound:g} s of each other"
    else:
        tests = [f for f in findings if f.test == equivalence.TOST]
        text = f"the means differ by less than ± {bound:g} s, before and after"
    same = bool(tests) and all(f.p < alpha for f in tests)
    return same, f"{text} ({p_text(max(f.p for f in tests))})" if same else ""


def _smallest(findings: list[Finding]) -> str:
    """Tell what the design could have found, in seconds where two groups are compared."""
    general = [f for f in findings if f.test.startswith("smallest effect") and f.effect > 0]
    pairs = [f for f in findings if f.test.startswith("smallest difference") and f.effect > 0]
    parts = []
    if general:
        f = general[0]
        spread = f.note.split("; ")[1]
        parts.append(f"At {f.power:.0%} power it finds f = {f.effect:.2f} ({spread})")
    if pairs:
        told = ", ".join(f"{f.comparison} {f.effect:.3f} s" for f in pairs)
        parts.append(f"Smallest differences found at {pairs[0].power:.0%} power: {told}")
    return ". ".join(parts) + "." if parts else ""


# --- 5.1: distance ----------------------------------------------------------------------------


def _distances(
    transitions: pd.DataFrame, unit: str, settings: Mapping[str, Any], rng: np.random.Generator
) -> list[Finding]:
    chosen = settings["durations"]
    alpha = chosen["alpha"]
    euclidean = f"euclidean_{unit}"
    whole = counted(transitions)
    plans = [("both", "manual", c) for c in ("geodesic_rad", euclidean, "mean_distance")]
    plans += [(h, s, euclidean) for h in ("right", "left") for s in ("manual", "refined")]
    out: list[Finding] = []
    for hand, segmentation, column in plans:
        rows = whole
        body = "whole body"
        if hand != "both":
            body = f"{hand} arm"
            rows = transitions[
                (transitions["hand"] == hand)
                & (transitions["segmentation"] == segmentation)
                & (transitions["status"] != "overlap")
            ]
        there = rows[rows[column].notna()]
        title = f"duration and {column}, {body}, {segmentation} tags"
        x, y = (there[c].to_numpy(dtype=float) for c in (column, "duration_s"))
        left = f"{len(rows) - len(there)} without this distance" if len(rows) > len(there) else ""
        found = association.correlations(
            x, y, list(there["recording"]), title, alpha, chosen["draws"],
            chosen["bootstrap_recordings"], rng,
        )  # fmt: skip
        if column != "mean_distance":
            found.append(association.isochrony(x, y, title, alpha))
        out += [f.noted(left) for f in found]
    points, _ = with_flags(transitions, settings["transitions"])
    held = points.loc[points["mean_distance"].notna(), "in_diamond"].to_numpy(dtype=bool)
    out.append(association.share(held, "share in the diamond (Fig. 8)", "all", alpha))
    out.append(_isochrony_in_words(out))
    return out


def _isochrony_in_words(findings: list[Finding]) -> Finding:
    found = [f for f in findings if f.test == "isochrony exponent" and "manual" in f.comparison]
    whole = [f for f in found if "whole body" in f.comparison and np.isfinite(f.effect)]
    if not whole:
        return Finding(IN_WORDS, "isochrony", note="no exponent can be fitted: see the reasons")
    told = []
    for f in whole:
        name = f.comparison.split(" and ")[1].split(",")[0]
        if f.effect_low > 1:
            what = "duration grows faster than the distance: no isochrony"
        elif f.effect_low > 0 and f.effect_high < 1:
            what = "longer ways are faster, but not of the same duration: isochrony in part"
        elif f.effect_low <= 0 and f.effect_high < 1:
            what = "no growth with the distance is shown"
        else:
            what = "neither constant speed nor isochrony in part is excluded"
        told.append(
            f"{name}: duration as distance to the power {f.effect:.2f} ({f.effect_low:.2f} to "
            f"{f.effect_high:.2f}), {what}"
        )
    return Finding(IN_WORDS, "isochrony", n=whole[0].n, note="; ".join(told) + ".")


# --- 5.2: models ------------------------------------------------------------------------------

MODELS = ("MEAN", "SIMPLE", "SIMPLE_BOUNDED", "LINEAR", "SURFACE", "SURFACE_PRINTED")
EVALUATIONS = ("in_sample", "leave_one_out", "leave_one_recording_out")
NOTHING_LEARNT = "nothing is learnt: the same in every evaluation"


@dataclass(frozen=True, eq=False)
class Learnable:
    """The transitions of a corpus that every model it allows can use, and why not all.

    rows: of the table `transitions`. data: the same in the models' units. unit: of the
    Euclidean distance in words. note: what was left out. absent: model -> why it is not tested.
    """

    rows: pd.DataFrame
    data: Transitions
    unit: str
    note: str
    absent: Mapping[str, str]


def learnable(
    transitions: pd.DataFrame, speeds: pd.DataFrame, unit: str, settings: Mapping[str, Any]
) -> Learnable:
    """Return the transitions between manual tags that all testable models can use."""
    rows = counted(transitions).merge(
        speeds.drop(columns="note"),
        on=["corpus", "recording", "signer", "transition"],
        validate="one_to_one",
    )
    scale = settings["transitions"]["euclidean_unit_m"] if unit == "m" else 1.0
    name = f"units of {scale:g} m" if unit == "m" else "px"
    angle = 1.0 if settings["durations"]["simple_angle"] == "half" else 2.0
    sides = ("previous", "next")
    linear = [f"{side}_linear_speed_{unit}_per_s" for side in sides]
    angular = [f"{side}_angular_speed_rad_per_s" for side in sides]
    data = Transitions(
        rows["geodesic_rad"].to_numpy(dtype=float),
        rows[f"euclidean_{unit}"].to_numpy(dtype=float) / scale,
        rows["duration_s"].to_numpy(dtype=float),
        rows[linear].to_numpy(dtype=float) / scale,
        rows[angular].to_numpy(dtype=float) * angle,
    )
    absent: dict[str, str] = {}
    usable = {"no Euclidean distance (gaps)": np.isfinite(data.euclidean)}
    if np.isfinite(data.geodesic).any():
        usable["no geodesic distance (gaps)"] = np.isfinite(data.geodesic)
        usable["a sign without speed"] = (
            (data.linear_speed.sum(axis=1) > 0) & (data.angular_speed.sum(axis=1) > 0)
        )  # fmt: skip
    else:
        reason = "no orientations, so no geodesic distance"
        absent |= dict.fromkeys(("SIMPLE", "SIMPLE_BOUNDED", "SURFACE", "SURFACE_PRINTED"), reason)
        if settings["durations"]["simple_alpha"] == 1:
            for model in ("SIMPLE", "SIMPLE_BOUNDED"):
                del absent[model]
            usable["a sign without speed"] = data.linear_speed.sum(axis=1) > 0
    if unit != "m":
        absent["SURFACE_PRINTED"] = "distances in px, theta in metres"
    kept = np.logical_and.reduce(list(usable.values()))
    told = [f"{int((~held).sum())} left out: {why}" for why, held in usable.items()]
    told = [text for text in told if not text.startswith("0 ")]
    return Learnable(rows[kept].reset_index(drop=True), data[kept], name, "; ".join(told), absent)


def makers(
    settings: Mapping[str, Any], constants: Mapping[str, str]
) -> dict[str, Callable[[], DurationModel]]:
    """Return how each model is made. constants: numbers printed in the paper, as strings."""
    chosen = settings["durations"]
    alpha = chosen["simple_alpha"]
    bounds = {"low_s": chosen["lowest_s"], "high_s": chosen["highest_s"]}
    printed = np.array([float(constants[f"theta_{term}"]) for term in TERMS])
    return {
        "MEAN": MeanDuration,
        "SIMPLE": lambda: SimpleDuration(alpha),
        "SIMPLE_BOUNDED": lambda: SimpleBoundedDuration(alpha, **bounds),
        "LINEAR": LinearDuration,
        "SURFACE": SurfaceDuration,
        "SURFACE_PRINTED": lambda: _Printed(theta=printed),
    }


class _Printed(SurfaceDuration):
    """The printed surface: it learns nothing."""

    def fit(self, *data: object, **speeds: object) -> SurfaceDuration:
        return self


def models(
    corpus: str,
    learn: Learnable,
    settings: Mapping[str, Any],
    constants: Mapping[str, str],
    seed: int,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the tables `duration_models` and `duration_predictions`."""
    chosen = settings["durations"]
    errors, predicted = [], []
    baseline: dict[str, np.ndarray] = {}
    recordings = list(learn.rows["recording"])
    groups = {
        "in_sample": None,
        "leave_one_out": list(range(len(learn.data))),
        "leave_one_recording_out": recordings,
    }
    for name, make in makers(settings, constants).items():
        for evaluation, members in groups.items():
            lead: dict[str, Any] = {"corpus": corpus, "model": name, "evaluation": evaluation}
            lead["n"] = len(learn.data)
            try:
                if name in learn.absent:
                    raise SignkinError(learn.absent[name])
                if members is None:
                    found = learn.data.ask(learn.data.teach(make()))
                else:
                    found = predict_left_out(make, learn.data, members)
            except SignkinError as error:
                reason = error.found
                if evaluation == "leave_one_recording_out" and len(set(recordings)) < 2:
                    reason = "one recording only"
                errors.append({**lead, "note": f"not testable: {reason}"})
                continue
            note = learn.note
            if name.startswith("SIMPLE") or name == "SURFACE_PRINTED":
                note = "; ".join(filter(None, (NOTHING_LEARNT, note)))
            if name == "MEAN":
                baseline[evaluation] = np.abs(found - learn.data.duration_s)
            # One stream for all: models are compared on the same draws.
            rng = seeds.stream(seed, corpus, "duration_models")
            measured = _errors(found, baseline[evaluation], learn, recordings, chosen, rng)
            errors.append({**lead, **measured, "note": note})
            if evaluation == "leave_one_out":
                predicted.append(_predictions(learn.rows, name, found))
    names = tables.TABLES["duration_predictions"].names()
    together = pd.concat(predicted, ignore_index=True) if predicted else None
    return (
        pd.DataFrame(errors).reindex(columns=tables.TABLES["duration_models"].names()),
        pd.DataFrame(columns=names) if together is None else together[names],
    )


def _errors(
    found: np.ndarray,
    baseline: np.ndarray,
    learn: Learnable,
    recordings: list[str],
    chosen: Mapping[str, Any],
    rng: np.random.Generator,
) -> dict[str, float]:
    residual = found - learn.data.duration_s
    units, _ = association.resampled_units(recordings, chosen["bootstrap_recordings"])
    absolute = np.abs(residual)

    def means(rows: np.ndarray) -> np.ndarray:
        return np.array([absolute[rows].mean(), (baseline - absolute)[rows].mean()])

    low, high = association.bootstrap(means, units, chosen["draws"], chosen["alpha"], rng)
    measured = {
        "mean_error_s": absolute.mean(),
        "mean_error_low_s": low[0],
        "mean_error_high_s": high[0],
        "gain_s": (baseline - absolute).mean(),
        "gain_low_s": low[1],
        "gain_high_s": high[1],
        "rmse_s": np.sqrt(np.mean(residual**2)),
        "bias_s": residual.mean(),
        "longest_s": found.max(),
        "share_above_bound": (found > chosen["highest_s"] + 1e-12).mean(),
    }
    # A bias of least squares is 0 but for rounding.
    return {name: round(float(value), 12) for name, value in measured.items()}


def _predictions(rows: pd.DataFrame, name: str, found: np.ndarray) -> pd.DataFrame:
    out = rows[["corpus", "recording", "signer", "transition"]].copy()
    out["model"] = name
    out["duration_s"] = rows["duration_s"].to_numpy(dtype=float)
    out["predicted_s"] = found
    return out


def coefficients(
    corpus: str,
    learn: Learnable,
    settings: Mapping[str, Any],
    constants: Mapping[str, str],
    seed: int,
) -> pd.DataFrame:
    """Return the table `duration_coefficients`: LINEAR and SURFACE, beside what is printed."""
    rng = seeds.stream(seed, corpus, "duration_coefficients")
    units = {"constant": "s", "mean_distance": "s/unit", "geodesic": "s/rad"}
    units["euclidean"] = f"s per {learn.unit.removeprefix('units of ')}"
    out = []
    for name, terms in (("LINEAR", LINEAR_TERMS), ("SURFACE", TERMS)):
        try:
            if name in learn.absent:
                raise SignkinError(learn.absent[name])
            values = _coefficients(name, learn, settings["durations"], rng)
            note = learn.note
        except SignkinError as error:
            values, note = pd.DataFrame(index=range(len(terms))), f"not testable: {error.found}"
        for i, term in enumerate(terms):
            row = {"corpus": corpus, "model": name, "coefficient": term, "unit": units[term]}
            row["published"] = constants[f"theta_{term}"] if name == "SURFACE" else ""
            row |= {str(k): v for k, v in values.iloc[i].to_dict().items()}
            row["published_inside"] = _inside(row)
            out.append({**row, "n": len(learn.data), "note": note})
    return pd.DataFrame(out).reindex(columns=tables.TABLES["duration_coefficients"].names())


def _coefficients(
    name: str, learn: Learnable, chosen: Mapping[str, Any], rng: np.random.Generator
) -> pd.DataFrame:
    model: LinearDuration | SurfaceDuration
    model = LinearDuration() if name == "LINEAR" else SurfaceDuration()
    learn.data.teach(model)
    freedom = model.n - len(model.theta)
    half = stats.t.isf(chosen["alpha"] / 2, freedom) * model.standard_error
    recordings = list(learn.rows["recording"])
    units, _ = association.resampled_units(recordings, chosen["bootstrap_recordings"])

    def theta(rows: np.ndarray) -> np.ndarray:
        again = LinearDuration() if name == "LINEAR" else SurfaceDuration()
        try:
            learn.data[rows].teach(again)
        except SignkinError:  # a draw of nothing but one transition, many times over
            return np.full(len(model.theta), np.nan)
        return again.theta

    low, high = association.bootstrap(theta, units, chosen["draws"], chosen["alpha"], rng)
    return pd.DataFrame(
        {
            "fitted": model.theta,
            "standard_error": model.standard_error,
            "low": model.theta - half,
            "high": model.theta + half,
            "bootstrap_low": low,
            "bootstrap_high": high,
        }
    )


def _inside(row: Mapping[str, Any]) -> str:
    if not row["published"] or "low" not in row:
        return ""
    value = float(row["published"])
    held = row["low"] <= value <= row["high"]
    return "yes" if held and row["bootstrap_low"] <= value <= row["bootstrap_high"] else "no"


def surface_points(learn: Learnable) -> tuple[pd.DataFrame, np.ndarray | None, str]:
    """Return the table `surface_points` (Fig. 11), theta, and why there is no surface."""
    out = learn.rows[["corpus", "recording", "signer", "transition", "geodesic_rad"]].copy()
    out["euclidean_units"] = learn.data.euclidean
    out["duration_s"] = learn.data.duration_s
    theta, reason = None, ""
    try:
        model = SurfaceDuration()
        out["surface_s"] = learn.data.ask(learn.data.teach(model))
        theta = model.theta
    except SignkinError as error:
        out["surface_s"], reason = np.nan, error.found
    return out[tables.TABLES["surface_points"].names()], theta, reason
