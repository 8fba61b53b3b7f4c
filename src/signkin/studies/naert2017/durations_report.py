"""What the report shows of durations: models, Fig. 11, statistics, of one corpus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from signkin.report.page import FigureView, TableView
from signkin.settings.sections import Durations
from signkin.studies.naert2017.settings import DurationSettings
from signkin.tables import read_table

SIMULATED = " Simulated: the durations carry the printed Table 2; it is a test of the method only."


def statistics_views(
    folder: Path, settings: DurationSettings, simulated: bool
) -> Iterator[TableView]:
    """Yield the tables of tests of one corpus; folder: results/naert2017/<corpus>."""
    warning = SIMULATED if simulated else ""
    yield from _statistics(folder / "statistics.csv", settings.durations, warning)


def model_views(
    folder: Path,
    settings: DurationSettings,
    constants: Mapping[str, str],
    exhibit: Mapping[str, str],
    simulated: bool,
) -> Iterator[TableView | FigureView]:
    """Yield the tables and figures about models of duration of one corpus.

    folder: results/naert2017/<corpus>. constants: numbers printed in the paper's text.
    exhibit: the entry fig11 of exhibits.yaml.
    """
    warning = SIMULATED if simulated else ""
    chosen = settings.durations
    coefficients = read_table(folder / "duration_coefficients.csv", "duration_coefficients")
    if (folder / "fig11.svg").exists():
        yield FigureView(
            label=exhibit["label"],
            title=exhibit["title"],
            caption=_surface_caption(folder, coefficients, constants, warning),
            svg=folder / "fig11.svg",
            files=[folder / f"fig11{suffix}" for suffix in (".svg", ".pdf", ".csv")],
            differs=exhibit["differs"],
        )
    models = read_table(folder / "duration_models.csv", "duration_models")
    yield _models(folder, models, chosen, constants, warning)
    yield FigureView(
        label="",
        title="Duration models against the truth",
        caption=_predictions_caption(models, warning),
        svg=folder / "fig_durations.svg",
        files=[folder / f"fig_durations{suffix}" for suffix in (".svg", ".pdf", ".csv")],
    )
    yield _coefficients(folder, coefficients, chosen, settings, warning)


# --- statistics ------------------------------------------------------------------------------


STATISTICS_COLUMNS = {
    "question": ("question", ""),
    "outliers": ("outliers", ""),
    "test": ("test", ""),
    "comparison": ("of", ""),
    "tested": ("statistic", ""),
    "p": ("p", ".2g"),
    "p_holm": ("p (Holm)", ".2g"),
    "sized": ("effect [interval]", ""),
    "n": ("n", "d"),
    "powered": ("power", ""),
    "statistic": ("difference (s)", ".3f"),
    "effect": ("value", ".3f"),
    "effect_low": ("low", ".3f"),
    "effect_high": ("high", ".3f"),
    "note": ("note", ""),
}


def _columns(*names: str) -> dict[str, tuple[str, str]]:
    return {name: STATISTICS_COLUMNS[name] for name in names}


def _statistics(path: Path, chosen: Durations, warning: str) -> Iterator[TableView]:
    frame = read_table(path, "statistics")
    yield _words(path, frame[frame["kind"] == "words"], chosen, warning)
    rest = frame[frame["kind"] != "words"]
    rest = rest.assign(
        tested=[_statistic(row) for row in rest.itertuples()],
        sized=[_effect(row) for row in rest.itertuples()],
        powered=[_power(row) for row in rest.itertuples()],
    )
    pairs = rest["kind"] == "pair"
    distance = rest["question"] == "distance"
    yield _tests(path, rest[~pairs & ~distance], chosen, warning)
    yield _pairs(path, rest[pairs], chosen, warning)
    yield _distance(path, rest[distance], chosen, warning)


def _words(path: Path, words: pd.DataFrame, chosen: Durations, warning: str) -> TableView:
    return TableView(
        label="",
        title="Do durations differ by type, and with distance? In words",
        caption="Section 5.1 says that hands and symmetry 'do not significantly impact' the "
        "duration, and gives no test. That is no evidence of no effect, so equivalence is tested "
        f"too: two means count as the same within ± {chosen.equivalence_s:g} s (a choice, see "
        "docs/interpretations.md). By Welch's ANOVA (type, change of hands) and type II sums of "
        f"squares (two factors), level {chosen.alpha:g}, corrected by Holm for all deciding "
        "tests of a corpus: all ask whether the types of signs matter. Symmetry is that of "
        "two-handed signs only. "
        f"Transitions between manual tags, whole body, overlapping signs left out.{warning}",
        frame=words,
        columns={
            "comparison": ("question", ""),
            "outliers": ("outliers", ""),
            "n": ("n", "d"),
            "note": ("what follows", ""),
            "assumptions": ("assumptions", ""),
        },
        file=path,
    )


def _level(chosen: Durations) -> str:
    return f"{1 - chosen.alpha:.0%}"


def _tests(path: Path, rows: pd.DataFrame, chosen: Durations, warning: str) -> TableView:
    return TableView(
        label="",
        title="Tests of duration by sign type",
        caption=f"Durations in s; intervals {_level(chosen)} (TOST: {1 - 2 * chosen.alpha:.0%})"
        ". Eta and omega squared estimate the same share of variance and have its interval. Power: "
        f"to find Cohen's f = {chosen.effect_f:g} with this n (TOST: to show equivalence of "
        "equal means). A dash is a number that the test does not have, or that the note says is "
        f"missing.{warning}",
        frame=rows,
        columns=_columns(
            "question", "outliers", "test", "comparison", "tested", "p", "p_holm", "sized", "n",
            "powered", "note",
        ),
        file=path,
        most=12,
    )  # fmt: skip


def _pairs(path: Path, rows: pd.DataFrame, chosen: Durations, warning: str) -> TableView:
    small = rows.sort_values(["test", "p"], kind="stable")
    return TableView(
        label="",
        title="Pairs of types",
        caption=f"Tukey's HSD and Games-Howell, p adjusted for all pairs of a test; "
        f"{int((small['p'] < chosen.alpha).sum())} of {int(small['p'].notna().sum())} rows "
        f"below {chosen.alpha:g}. Smallest p first; difference of the means in s, Cohen's d "
        f"with its {_level(chosen)} interval.{warning}",
        frame=small,
        columns=_columns("outliers", "test", "comparison", "statistic", "p", "sized", "n", "note"),
        file=path,
        most=6,
    )


def _distance(path: Path, rows: pd.DataFrame, chosen: Durations, warning: str) -> TableView:
    return TableView(
        label="",
        title="Duration and distance",
        caption=f"Pearson's and Spearman's correlation with {_level(chosen)} bootstrap intervals "
        f"({chosen.draws} draws); the isochrony exponent b of duration = a · distance^b; the "
        f"share of transitions in the diamond of Fig. 8.{warning}",
        frame=rows,
        columns=_columns(
            "test", "comparison", "effect", "effect_low", "effect_high", "p", "p_holm", "n", "note"
        ),
        file=path,
        most=12,
    )


def _statistic(row: Any) -> str:
    """Return `F(3, 85) = 1.234`, empty where the test has no statistic."""
    if pd.isna(row.statistic):
        return ""
    degrees = ", ".join(f"{df:.4g}" for df in (row.df1, row.df2) if pd.notna(df))
    return f"{row.statistic_name}{f'({degrees})' if degrees else ''} = {row.statistic:.3f}"


def _effect(row: Any) -> str:
    """Return `eta squared 0.106 [0.000, 0.130]`."""
    if pd.isna(row.effect):
        return ""
    ends = [f"{end:.3f}" for end in (row.effect_low, row.effect_high) if pd.notna(end)]
    return f"{row.effect_name} {row.effect:.3f}" + (f" [{', '.join(ends)}]" if ends else "")


def _power(row: Any) -> str:
    return "" if pd.isna(row.power) else f"{row.power:.2f} for {row.power_for}"


# --- models ----------------------------------------------------------------------------------


def _models(
    folder: Path,
    frame: pd.DataFrame,
    chosen: Durations,
    constants: Mapping[str, str],
    warning: str,
) -> TableView:
    shown = frame.assign(evaluation=frame["evaluation"].str.replace("_", " "))
    return TableView(
        label="",
        title="Duration models (5.2)",
        caption=f"Errors in s over {int(frame['n'].max())} transitions, the same for all models. "
        "Mean error: eq. 5 (in sample, SURFACE, the paper: "
        f"{constants['mean_error']} s); left out: each transition, or each recording, predicted by "
        "a model that learnt from the others. Gain: how much smaller the mean error is than that "
        "of the mean duration (MEAN), with its bootstrap interval; at or below 0 the model is of "
        f"no use. SIMPLE: alpha = {chosen.simple_alpha:g} (not printed).{warning}",
        frame=shown,
        columns={
            "model": ("model", ""),
            "evaluation": ("evaluation", ""),
            "mean_error_s": ("mean error (s)", ".4f"),
            "mean_error_low_s": ("low", ".4f"),
            "mean_error_high_s": ("high", ".4f"),
            "gain_s": ("gain (s)", "+.4f"),
            "gain_low_s": ("low", "+.4f"),
            "gain_high_s": ("high", "+.4f"),
            "rmse_s": ("RMSE (s)", ".4f"),
            "bias_s": ("bias (s)", "+.4f"),
            "bias_low_s": ("low", "+.4f"),
            "bias_high_s": ("high", "+.4f"),
            "share_too_long": ("too long", ".0%"),
            "share_above_bound": (f"above {chosen.highest_s:g} s", ".0%"),
            "note": ("note", ""),
        },
        file=folder / "duration_models.csv",
    )


def _predictions_caption(models: pd.DataFrame, warning: str) -> str:
    tested = models[(models["evaluation"] == "leave_one_out") & models["mean_error_s"].notna()]
    absent = models[(models["evaluation"] == "leave_one_out") & models["mean_error_s"].isna()]
    text = (
        "Predicted over true duration in s; each transition is predicted by a model that learnt "
        f"from all others, n = {int(models['n'].max())}. Dashed: equality. Red triangles: "
        "predictions above the axis."
    )
    if len(tested):
        best = tested.loc[tested["mean_error_s"].idxmin()]
        text += f" Least mean error: {best['model']}, {best['mean_error_s']:.3f} s."
    for note, rows in absent.groupby("note", sort=True):
        text += f" {', '.join(rows['model'])}: {note}."
    return text + warning


def _coefficients(
    folder: Path,
    frame: pd.DataFrame,
    chosen: Durations,
    settings: DurationSettings,
    warning: str,
) -> TableView:
    level = f"{1 - chosen.alpha:.0%}"
    return TableView(
        label="",
        title="Coefficients of LINEAR and SURFACE",
        caption=f"Least squares on {int(frame['n'].max())} transitions; {level} intervals by "
        f"Student's t and by bootstrap ({chosen.draws} draws). Euclidean distances in units of "
        f"{settings.transitions.euclidean_unit_m:g} m where the corpus is in metres. The paper "
        f"prints theta of SURFACE for its own corpus.{warning}",
        frame=frame,
        columns={
            "model": ("model", ""),
            "coefficient": ("coefficient", ""),
            "unit": ("unit", ""),
            "published": ("printed", ""),
            "fitted": ("fitted", ".6f"),
            "standard_error": ("standard error", ".4f"),
            "low": ("low", ".4f"),
            "high": ("high", ".4f"),
            "bootstrap_low": ("bootstrap low", ".4f"),
            "bootstrap_high": ("bootstrap high", ".4f"),
            "published_inside": ("printed inside", ""),
            "note": ("note", ""),
        },
        file=folder / "duration_coefficients.csv",
    )


def _surface_caption(
    folder: Path, coefficients: pd.DataFrame, constants: Mapping[str, str], warning: str
) -> str:
    points = read_table(folder / "fig11.csv", "surface_points")
    theta: Sequence[float] = coefficients.loc[coefficients["model"] == "SURFACE", "fitted"].tolist()
    if pd.isna(theta).any():
        note = coefficients.loc[coefficients["model"] == "SURFACE", "note"].iloc[0]
        return f"Durations over both distances, n = {len(points)}; no surface: {note}.{warning}"
    above = int((points["duration_s"] >= points["surface_s"]).sum())
    printed = ", ".join(constants[f"theta_{t}"] for t in ("constant", "geodesic", "euclidean"))
    return (
        f"Duration (s) over the geodesic (rad) and Euclidean distance, n = {len(points)} "
        "transitions between manual tags, and the fitted surface: "
        f"{theta[0]:.4f} {theta[1]:+.4f} geodesic {theta[2]:+.4f} Euclidean (printed: {printed}). "
        f"Left: {above} transitions on or above the surface (blue disks), {len(points) - above} "
        "below (red triangles), each joined to it. Right: the same from above, lines of equal "
        "duration on the surface, transitions shaded from the 2 % to the 98 % quantile of "
        f"duration.{warning}"
    )
