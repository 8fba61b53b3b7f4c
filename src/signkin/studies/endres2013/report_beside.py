"""What the report shows beside the results: whether the noise fits, and other priors."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from signkin.binning.posterior import MOST_MISFIT
from signkin.report.page import FigureView, TableView, figure_files
from signkin.studies.endres2013.two_priors import BESIDE, SHIPPED, printed_beside
from signkin.tables import read_table


def doubts(folder: Path) -> Iterator[TableView]:
    """Yield how far the noise is from what the prior expects, and what the longest segment makes.

    folder: results/endres2013/<corpus>.
    """
    path = folder / "binning.csv"
    frame = read_table(path, "binning")
    own = frame[frame["dataset"].isin(["recorded", "powerlaw"])]
    if own.empty:
        return
    told = own.assign(off=own["noise_misfit"] > MOST_MISFIT, floor=own["at_floor"] == "yes")
    rows = told.groupby(["dataset", "order"], sort=False).agg(
        misfit=("noise_misfit", "median"), off=("off", "sum"), floor=("floor", "sum"),
        n=("recording", "size"),
    )  # fmt: skip
    off, floor, n = (int(rows[column].sum()) for column in ("off", "floor", "n"))
    yield TableView(
        label="",
        title="Does the noise fit?",
        caption="How far the data lie off the expected path, in SDs of the noise that the prior "
        f"expects: {off} of {n} fits lie above {MOST_MISFIT:g}, where polynomials do not follow "
        "the path or the prior expects too little noise; far below 1 it expects more than is "
        f"left after the low-pass. {floor} of {n} have no more boundaries than the longest "
        "segment makes. Each fit's row has a note.",
        frame=rows.reset_index(),
        columns={
            "dataset": ("data", ""),
            "order": ("order", "d"),
            "misfit": ("median misfit (SDs)", ".2f"),
            "off": (f"above {MOST_MISFIT:g}", "d"),
            "floor": ("boundaries at the floor", "d"),
            "n": ("n", "d"),
        },
        file=path,
    )


def figure(folder: Path, name: str, title: str, *others: str) -> FigureView:
    """Return the view of a figure that is no exhibit; others: tables beside its own."""
    base = folder / f"fig_{name}"
    return FigureView(
        label="",
        title=title,
        caption=(folder / f"{name}.txt").read_text(encoding="utf-8").strip(),
        svg=base.with_suffix(".svg"),
        files=[
            *figure_files(base, ".svg", ".pdf"),
            *(folder / f for f in (f"{name}.csv", *others)),
        ],
    )


def learnt(folder: Path) -> Iterator[TableView]:
    """Yield what the recordings say of the prior (empirical Bayes); nothing where too few are."""
    path = folder / "learnt_prior.csv"
    frame = read_table(path, "learnt_prior")
    if frame.empty:
        return
    noise = next(str(column) for column in frame.columns if str(column).startswith("noise_sd_"))
    shown = frame.assign(noise_mm=frame[noise] * 1e3 if noise == "noise_sd_m" else frame[noise])
    yield TableView(
        label="",
        title="The prior that the recordings ask for",
        caption="Degrees of freedom, noise and concentration under which the evidence of one half "
        "of the recordings is greatest (order shared), and how well they predict the other half, "
        "beside priors that are told. Gain: nats a held-out trajectory over the prior of "
        "config.yaml, ± standard error. A model whose noise is white puts the noise of low-passed "
        "paths far below the sensor's.",
        frame=shown,
        columns={
            "held_out": ("held out", ""),
            "prior": ("prior", ""),
            "dof": ("nu", ".3g"),
            "noise_mm": ("noise (mm)" if noise == "noise_sd_m" else "noise (px)", ".3g"),
            "concentration": ("b", ".2g"),
            "order": ("order", "d"),
            "order_probability": ("P", ".2f"),
            "log_density_held_out": ("nats a number, held out", ".3f"),
            "gain": ("gain", ".1f"),
            "gain_se": ("± SE", ".1f"),
            "note": ("note", ""),
        },
        file=path,
    )


def two_priors(folder: Path) -> Iterator[TableView | FigureView]:
    """Yield Fig. 3 to 7 under the prior of config.yaml and the one beside it: figure and table."""
    path = folder / "two_priors.csv"
    table = read_table(path, "two_priors")
    yield figure(folder, "two_priors", "Fig. 3 to 7 under two readings of the prior")
    names = dict(table.groupby("reading")["prior"].first())
    yield TableView(
        label="",
        title="Printed, and found under two readings of the prior",
        caption="The data's variances as the scale matrix V itself, in a unit of length, keep all "
        "that section 3.2 prints, as do other readings (the figure of all settings).",
        frame=_shown(table),
        columns={
            "what": ("what", ""),
            "where": ("where", ""),
            "printed": ("paper", ""),
            SHIPPED: (str(names.get(SHIPPED, SHIPPED)), ""),
            BESIDE: (str(names.get(BESIDE, BESIDE)), ""),
        },
        file=path,
    )


def _shown(table: pd.DataFrame) -> pd.DataFrame:
    return printed_beside(table).replace("", "none")
