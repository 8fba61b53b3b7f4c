"""Figures of Endres et al. 2013 for one corpus, the points drawn in them, and their captions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.figures import binning as drawing
from signkin.figures import powerlaw as law_drawing
from signkin.figures.style import WIDTH_IN
from signkin.io.store import read_recordings
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.posteriors import FITTED, FITTED_MAP, read_posteriors
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    example_points,
    read_trajectories,
)
from signkin.studies.endres2013.summaries import ALL

FIGURES = ("fig01", "fig03", "fig04", "fig05", "fig06", "fig07", "figA1")
EXAMPLE_ORDERS = (0, 3, 6)
FITTED_ORDER = 3
KINDS = {FITTED: "averaged", FITTED_MAP: "most probable"}
MOST_PANELS = 2  # signers and signs drawn in Fig. 5, each


def _point(panel: str, series: str, x: float, y: float, **more: Any) -> dict[str, Any]:
    return {"panel": panel, "series": series, "x": x, "y": y, **more}


def _frame(corpus: str, rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    frame = pd.DataFrame(rows, columns=tables.TABLES["endres_figure"].names()[1:])
    frame["label"] = frame["label"].astype(object).fillna("")
    frame.insert(0, "corpus", corpus)
    return frame


def _panel(frame: pd.DataFrame, name: str) -> pd.DataFrame:
    return frame[frame["panel"] == name]


# --- Fig. 1 ----------------------------------------------------------------------------------


def fig01(points: pd.DataFrame, segments: pd.DataFrame, unit: str) -> Drawn:
    """Draw a recorded path and its power-law timing. points: table `fig01_powerlaw`."""
    before = points[points["dataset"] == RECORDED].reset_index(drop=True)
    after = points[points["dataset"] == POWERLAW].reset_index(drop=True)
    spread = {axis: float(before[f"{axis}_{unit}"].std()) for axis in "xyz"}
    there = [axis for axis in "xyz" if np.isfinite(spread[axis])]
    a, b = sorted(sorted(there, key=lambda axis: -spread[axis])[:2])
    laws = {
        int(row.segment): (float(row.fitted_beta), float(row.r_squared))
        for row in segments.itertuples()
    }
    figure, axes = plt.subplot_mosaic(
        [["a", "a", "b"], ["a", "a", "c"], ["d", "d", "e"], ["d", "d", "e"]],
        figsize=(WIDTH_IN, 6.6),
    )
    law_drawing.plot_path(before, unit, (a, b), ax=axes["a"], by="time")
    law_drawing.plot_path(after, unit, (a, b), ax=axes["d"], by="segment")
    axes["a"].legend(handles=law_drawing.start_and_end(), loc="best")
    law_drawing.plot_law(before, laws, unit, ax=axes["b"], by="time")
    law_drawing.plot_law(after, laws, unit, ax=axes["c"], by="time")
    law_drawing.plot_law(after, laws, unit, ax=axes["e"], by="segment")
    titles = {
        "a": "a  recorded", "b": "b  recorded", "c": "c  warped, by time",
        "d": "d  warped: segments of the ground truth", "e": "e  warped, by segment",
    }  # fmt: skip
    for name, title in titles.items():
        axes[name].set_title(title, loc="left")
    recording = str(points["recording"].iloc[0])
    betas = ", ".join(f"{beta:.2f}" for beta, _ in laws.values())
    least = min(r2 for _, r2 in laws.values())
    caption = (
        f"Recording {recording} before (a, b) and after (c, d, e) time warping, in the plane of "
        f"its two widest axes. Laws fitted again to the {len(after)} warped samples: β = {betas}; "
        f"R² from {least:.3f} (draws below powerlaw.least_r_squared are rejected, so a high R² "
        "says nothing about people). The path stays, the speed along it changes. Black lines in "
        "e: the laws."
    )
    return Drawn(figure, points, caption)


# --- Fig. 2 ----------------------------------------------------------------------------------


def fig02() -> tuple[Figure, pd.DataFrame]:
    """Draw the scheme of segments, and return the boundaries drawn."""
    ends, bins = (4, 8, 14), 15
    figure, ax = plt.subplots(figsize=(WIDTH_IN, 2.6))
    drawing.plot_scheme(ends, bins, ax=ax)
    rows = [
        _point("scheme", "boundaries", end + 1, 0, label=f"q_{m}") for m, end in enumerate(ends)
    ]
    return figure, _frame("", rows)


# --- Fig. 3 ----------------------------------------------------------------------------------


def order_points(posteriors: pd.DataFrame, panel: str, series: str) -> list[dict[str, Any]]:
    """Return the points of an order posterior. posteriors: rows of `order_posteriors`."""
    return [
        _point(panel, series, row.order, row.mean_probability, y_error=row.se)
        for row in posteriors.itertuples()
    ]


def hit_points(rates: pd.DataFrame, panel: str, series: str) -> list[dict[str, Any]]:
    """Return the points of hit rates over false positives. rates: rows of `hit_rates`."""
    return [
        _point(
            panel, series, row.false_positives_per_s, row.hit_rate,
            x_error=row.false_positives_per_s_se, y_error=row.hit_rate_se, label=f"{row.order}",
        )
        for row in rates.itertuples()
        if pd.notna(row.hit_rate)
    ]  # fmt: skip


def chance_points(lines: pd.DataFrame, panel: str) -> list[dict[str, Any]]:
    """Return the points of a chance line. lines: rows of `chance_lines` of one group."""
    columns = {
        "chance": "hit_rate", "chance low": "hit_rate_low", "chance high": "hit_rate_high",
        "closed form": "closed_form",
    }  # fmt: skip
    out = []
    for series, column in columns.items():
        across = "rate_per_s" if series == "closed form" else "false_positives_per_s"
        out += [
            _point(panel, series, x, y) for x, y in zip(lines[across], lines[column], strict=True)
        ]
    return out


def _group(table: pd.DataFrame, dataset: str, true_order: int | None = None, **key: str) -> Any:
    here = table["dataset"] == dataset
    if true_order is not None:
        here &= table["true_order"] == true_order
    for column in ("signer", "sign"):
        here &= table[column] == key.get(column, ALL)
    return table[here]


def fig03(
    corpus: str, fits: pd.DataFrame, x: np.ndarray, orders: pd.DataFrame, rates: pd.DataFrame,
    lines: pd.DataFrame, unit: str,
) -> Drawn:  # fmt: skip
    """Draw fitted trajectories and what binning recovers from them.

    fits: posteriors of one recorded trajectory. x: (T, L) that trajectory.
    """
    rows = _fit_rows(fits, x, FITTED_ORDER)
    for kind, series in KINDS.items():
        rows += order_points(_group(orders, kind, FITTED_ORDER), "B", series)
        rows += hit_points(_group(rates, kind, FITTED_ORDER), "C", series)
    rows += chance_points(_group(lines, FITTED, FITTED_ORDER), "C")
    recorded = _group(orders, RECORDED)
    rows += [
        _point(
            "D", "explained variance", row.order, row.mean_explained_variance,
            y_error=row.sd_explained_variance, label=f"{row.mean_count:.1f}",
        )
        for row in recorded.itertuples()
    ]  # fmt: skip
    frame = _frame(corpus, rows)
    figure, axes = plt.subplots(2, 2, figsize=(WIDTH_IN, 5.8))
    colours = {f"{axis}, order {FITTED_ORDER}": drawing.FIT_COLOURS[0] for axis in "xyz"}
    drawing.plot_curves(
        _panel(frame, "A"), ax=axes[0, 0], colours=colours, ylabel=f"position, centred ({unit})"
    )
    drawing.plot_orders(_panel(frame, "B"), ax=axes[0, 1], marked=FITTED_ORDER)
    drawing.plot_hit_rates(_panel(frame, "C"), ax=axes[1, 0])
    drawing.plot_explained(_panel(frame, "D"), ax=axes[1, 1])
    titles = (
        "A  recorded (grey) and order 3 (red)", "B  order posterior of fitted trajectories",
        "C  hit rates of fitted trajectories", "D  explained variance, mean M below",
    )  # fmt: skip
    for ax, title in zip(axes.flat, titles, strict=True):
        ax.set_title(title, loc="left")
    kept = int(_group(orders, FITTED, FITTED_ORDER)["n"].max())
    caption = (
        f"A: the coordinates of recording {fits['recording'].iloc[0]}; dotted: its boundaries at "
        f"order 3. B, C: {kept} trajectories fitted with order 3, taken as data: the paper's, "
        "averaged over segmentations, and those of the most probable segmentation, which are "
        "exactly piecewise cubic; both with the prior's noise at binning.recovery_noise. Numbers "
        "at the marks of C are orders; dashed: Poisson events through the same matcher (grey: "
        f"95 %), dotted: the closed form. D: {int(recorded['n'].max())} recorded trajectories, "
        "± SD; numbers: mean M. Errors in B and C are standard errors."
    )
    return Drawn(figure, frame, caption)


def _fit_rows(fits: pd.DataFrame, x: np.ndarray, order: int) -> list[dict[str, Any]]:
    fit = fits[(fits["dataset"] == RECORDED) & (fits["order"] == order)].iloc[0]
    time_s = (np.arange(len(x)) + 0.5) * fit["bin_s"]
    expected = np.asarray(fit["expected"]).reshape(x.shape)
    centred = x - x.mean(axis=0)
    rows = []
    for axis in range(x.shape[1]):
        letter = "xyz"[axis]
        rows += [_point("A", letter, t, y) for t, y in zip(time_s, centred[:, axis], strict=True)]
        rows += [
            _point("A", f"{letter}, order {order}", t, y)
            for t, y in zip(time_s, expected[:, axis], strict=True)
        ]
    rows += [_point("A", "boundaries", t, 0) for t in fit["boundaries_s"]]
    return rows


# --- Fig. 4 ----------------------------------------------------------------------------------


def fig04(corpus: str, fits: pd.DataFrame, x: np.ndarray, unit: str) -> Drawn:
    """Draw one coordinate of a ground-truth trajectory with fits and segmentation densities."""
    mine = fits[fits["dataset"] == POWERLAW].set_index("order")
    present = [order for order in EXAMPLE_ORDERS if order in mine.index]
    axis = int(np.argmax(x.std(axis=0)))
    bin_s = float(mine["bin_s"].iloc[0])
    time_s = (np.arange(len(x)) + 0.5) * bin_s
    centred = x[:, axis] - x[:, axis].mean()
    rows = [_point("trajectory", "trajectory", t, y) for t, y in zip(time_s, centred, strict=True)]
    truth = np.asarray(mine["true_boundaries_s"].iloc[0])
    for order in present:
        fit = mine.loc[order]
        expected = np.asarray(fit["expected"]).reshape(x.shape)[:, axis]
        rows += [
            _point("trajectory", f"order {order}", t, y)
            for t, y in zip(time_s, expected, strict=True)
        ]
        density = np.asarray(fit["boundary_probability"], dtype=float) / bin_s
        rows += [
            _point(f"order {order}", "density", (q + 1) * bin_s, y) for q, y in enumerate(density)
        ]
        rows += [_point(f"order {order}", "true boundaries", t, 0) for t in truth]
    rows += [_point("trajectory", "true boundaries", t, 0) for t in truth]
    frame = _frame(corpus, rows)
    figure, axes = plt.subplots(
        1 + len(present), 1, figsize=(WIDTH_IN, 1.9 + 1.15 * len(present)), sharex=True,
        height_ratios=[1.9, *[1.0] * len(present)],
    )  # fmt: skip
    colours = {f"order {order}": drawing.FIT_COLOURS[order] for order in present}
    drawing.plot_curves(
        _panel(frame, "trajectory"), ax=axes[0], colours=colours,
        ylabel=f"{'xyz'[axis]}, centred ({unit})",
    )  # fmt: skip
    axes[0].set_xlabel("")
    for order in present:
        axes[0].plot([], [], color=drawing.FIT_COLOURS[order], label=f"order {order}")
    axes[0].plot([], [], color="0.05", lw=2.2, alpha=0.45, label="trajectory")
    axes[0].plot([], [], color="0.15", ls=":", label="true boundary")
    axes[0].legend(loc="best", ncols=2)
    for ax, order in zip(axes[1:], present, strict=True):
        drawing.plot_density(_panel(frame, f"order {order}"), drawing.FIT_COLOURS[order], ax=ax)
        count = int(mine.loc[order, "map_count"])
        ax.set_title(f"order {order}: most probable M = {count}", loc="left")
    axes[-1].set_xlabel("time (s)")
    axes[0].set_xlim(0, len(x) * bin_s)
    caption = (
        f"Power-law ground truth of recording {fits['recording'].iloc[0]}: the coordinate that "
        "varies most, with posterior expectations; below, the probability density of a boundary. "
        f"{len(truth)} true boundaries, dotted."
    )
    return Drawn(figure, frame, caption)


# --- Fig. 5, 6, 7, A1 ------------------------------------------------------------------------


def fig05(corpus: str, rates: pd.DataFrame, lines: pd.DataFrame) -> Drawn:
    """Draw hit rates on ground truth, for signers and signs; those with most trajectories."""
    mine = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] != ALL)]
    counted = mine[mine["n"] > mine["without_truth"]]
    sizes = counted.groupby(["signer", "sign"])["n"].max()
    signers = _largest(sizes, "signer")
    signs = _largest(sizes.loc[signers], "sign")
    rows = []
    for signer in signers:
        for sign in signs:
            name = f"{signer}, {sign}"
            part = _group(rates, POWERLAW, signer=signer, sign=sign)
            rows += hit_points(part, name, name)
            rows += chance_points(_group(lines, POWERLAW, signer=signer, sign=sign), name)
    frame = _frame(corpus, rows)
    figure, axes = plt.subplots(
        len(signers), len(signs), figsize=(WIDTH_IN, 0.4 + 2.5 * len(signers)), squeeze=False,
        sharex=True, sharey=True,
    )  # fmt: skip
    marks = frame[~frame["series"].str.startswith(("chance", "closed"))]
    right = float(np.nanmax([1.0, *(marks["x"] + marks["x_error"].fillna(0))])) * 1.12
    first = True
    for i, signer in enumerate(signers):
        for j, sign in enumerate(signs):
            points = _panel(frame, f"{signer}, {sign}")
            ax = axes[i, j]
            if not points.empty:
                drawing.plot_hit_rates(points, ax=ax, right=right, legend=False)
                if first:
                    handles, labels = ax.get_legend_handles_labels()
                    ax.legend(handles[:2], labels[:2], loc="lower right")
                    first = False
            n = int(sizes.get((signer, sign), 0))
            ax.set_title(f"signer {signer}, sign {sign} (n = {n})", loc="left")
            ax.label_outer()
    caption = (
        "Hit rate against false positives a second on power-law ground truth, for orders 0 to 7 "
        f"(numbers at the marks), ± standard errors; {len(signers)} of {mine['signer'].nunique()} "
        f"signers and {len(signs)} of {mine['sign'].nunique()} signs, those with most "
        "trajectories (hit_rates.csv has all). Dashed: Poisson events through the same matcher "
        "(grey: 95 % of sets of as many trajectories), dotted: the closed form."
    )
    return Drawn(figure, frame, caption)


def _largest(sizes: pd.Series, level: str) -> list[str]:
    totals = sizes.groupby(level=level).sum().sort_values(ascending=False, kind="stable")
    return sorted(str(name) for name in totals.index[:MOST_PANELS])


def _pooled_and_signers(table: pd.DataFrame, dataset: str) -> list[tuple[str, pd.DataFrame]]:
    """Return all trajectories, and where there are few groups, each of them."""
    out = [("all", _group(table, dataset))]
    mine = table[(table["dataset"] == dataset) & (table["signer"] != ALL)]
    keys = list(mine.groupby(["signer", "sign"]).groups)
    if 1 < len(keys) <= 4:
        out += [
            (f"{signer}, {sign}", _group(table, dataset, signer=signer, sign=sign))
            for signer, sign in keys
        ]
    return out


def fig06(corpus: str, orders: pd.DataFrame, rates: pd.DataFrame, tests: pd.DataFrame) -> Drawn:
    """Draw the order posterior on ground truth, and hits for each false positive a second."""
    rows = []
    for name, part in _pooled_and_signers(orders, POWERLAW):
        rows += order_points(part, "order posterior", name)
    for name, part in _pooled_and_signers(rates, POWERLAW):
        rows += [
            _point("ratio", name, row.order, row.hpfpps, y_error=row.hpfpps_se)
            for row in part.itertuples()
        ]
    frame = _frame(corpus, rows)
    figure, axes = plt.subplots(2, 1, figsize=(WIDTH_IN, 5.2))
    drawing.plot_orders(_panel(frame, "order posterior"), ax=axes[0])
    drawing.plot_ratio(_panel(frame, "ratio"), ax=axes[1])
    told = "; ".join(
        f"{row.test}, {row.question}: "
        + (f"statistic {row.statistic:.1f}, p = {row.p:.1e}" if not row.note else str(row.note))
        for row in tests.itertuples()
    )
    n = int(_group(orders, POWERLAW)["n"].max())
    caption = (
        f"{n} power-law ground-truth trajectories. Top: mean order posterior ± standard error. "
        "Bottom: hit rate over false positives a second (eq. 17), pooled over trajectories, ± "
        f"bootstrap standard error; no mark where there was no false positive. {told}."
    )
    return Drawn(figure, frame, caption)


def fig07(corpus: str, orders: pd.DataFrame) -> Drawn:
    """Draw the order posterior of the recorded trajectories."""
    rows = []
    for name, part in _pooled_and_signers(orders, RECORDED):
        rows += order_points(part, "order posterior", name)
    frame = _frame(corpus, rows)
    figure, ax = plt.subplots(figsize=(WIDTH_IN * 0.8, 2.9))
    drawing.plot_orders(frame, ax=ax)
    pooled = _group(orders, RECORDED).set_index("order")
    share = float(pooled["mean_probability"].reindex([3, 4, 5]).sum())
    caption = (
        f"{int(pooled['n'].max())} recorded trajectories, mean order posterior ± standard error. "
        f"Peak at order {int(pooled['mean_probability'].idxmax())}; P(3 ≤ S ≤ 5) = {share:.3f} "
        "(paper: peak at 4, above 0.95)."
    )
    return Drawn(figure, frame, caption)


def fig_a1(corpus: str, orders: pd.DataFrame, rates: pd.DataFrame, lines: pd.DataFrame) -> Drawn:
    """Draw what is recovered from trajectories fitted with each order (section A.1)."""
    there = sorted(int(o) for o in orders.loc[orders["dataset"] == FITTED, "true_order"].unique())
    rows = []
    for true in there:
        for kind, series in KINDS.items():
            rows += order_points(_group(orders, kind, true), f"P, order {true}", series)
            rows += hit_points(_group(rates, kind, true), f"hits, order {true}", series)
        rows += chance_points(_group(lines, FITTED, true), f"hits, order {true}")
    frame = _frame(corpus, rows)
    columns = 4
    blocks = -(-len(there) // columns)
    figure, axes = plt.subplots(
        2 * blocks, columns, figsize=(WIDTH_IN * 1.35, 3.6 * blocks), squeeze=False
    )
    marks = frame[~frame["series"].str.startswith(("chance", "closed", "averaged")) & (
        frame["panel"].str.startswith("hits"))]  # fmt: skip
    right = float(np.nanmax([1.0, *marks["x"]])) * 1.12
    for i, true in enumerate(there):
        top, bottom = (axes[2 * (i // columns) + k, i % columns] for k in (0, 1))
        drawing.plot_orders(_panel(frame, f"P, order {true}"), ax=top, marked=true, legend=False)
        drawing.plot_hit_rates(
            _panel(frame, f"hits, order {true}"), ax=bottom, right=right, legend=False
        )
        top.set_title(f"true order {true}", loc="left")
        if i % columns:
            top.set_ylabel("")
            bottom.set_ylabel("")
    spare = [axes[2 * (i // columns) + k, i % columns]
             for i in range(len(there), blocks * columns) for k in (0, 1)]  # fmt: skip
    for ax in spare:
        ax.set_axis_off()
    handles, labels = axes[0, 0].get_legend_handles_labels()
    more, names = axes[1, 0].get_legend_handles_labels()
    where = spare[0] if spare else axes[0, 0]
    where.legend(
        [*handles, *more], [*(f"P: {n}" for n in labels), *names], loc="center left", fontsize=7
    )
    kept = int(orders.loc[orders["dataset"] == FITTED, "n"].max()) if there else 0
    caption = (
        f"{kept} recorded trajectories fitted with each order, and binned again with orders 0 to "
        "7. Upper rows: order posterior, the red line at the true order. Lower rows: hit rate "
        "against false positives a second, orders at the marks, in the range of the most probable "
        "segmentation's (marks of the averaged ones may lie outside; figA1.csv has all)."
    )
    return Drawn(figure, frame, caption)


# --- all of them -----------------------------------------------------------------------------


def draw(
    corpus: Corpus,
    frames: Mapping[str, pd.DataFrame],
    recordings: Sequence[str],
    trajectories: Sequence[str],
    posteriors: Sequence[str],
    settings: Mapping[str, Any],
    seed: int,
) -> dict[str, Drawn]:
    """Draw Fig. 1, 3 to 7 and A1 of a corpus of single signs.

    frames: its tables. recordings, trajectories, posteriors: the files of its shards. The
    example of Fig. 1, 3A and 4 is the first recording that has a ground truth.
    """
    truth = frames["ground_truth"]
    if truth.empty:
        raise SignkinError(
            "no recording has a power-law ground truth",
            file=corpus.folder,
            expected="one or more; results/endres2013/<corpus>/left_out.csv tells why not",
        )
    example = str(truth["recording"].iloc[0])
    (recording,) = (r for path in recordings for r in read_recordings(Path(path), [example]))
    points = example_points(corpus, recording, settings, seed)
    fits = read_posteriors(posteriors, example)
    binned = {t.dataset: t.x for t in read_trajectories(trajectories) if t.recording == example}
    name, unit = corpus.name, corpus.unit
    orders, rates, lines = (
        frames[kind] for kind in ("order_posteriors", "hit_rates", "chance_lines")
    )
    return {
        "fig01": fig01(points, truth[truth["recording"] == example], unit),
        "fig03": fig03(name, fits, binned[RECORDED], orders, rates, lines, unit),
        "fig04": fig04(name, fits, binned[POWERLAW], unit),
        "fig05": fig05(name, rates, lines),
        "fig06": fig06(name, orders, rates, frames["order_tests"]),
        "fig07": fig07(name, orders),
        "figA1": fig_a1(name, orders, rates, lines),
    }
