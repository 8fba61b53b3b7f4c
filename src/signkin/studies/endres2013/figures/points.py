"""Points drawn, as rows of the table `endres_figure`: panel, series, x, y, their errors, label."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from signkin import tables
from signkin.studies.endres2013.summaries import ALL

Row = dict[str, Any]


def point(panel: str, series: str, x: float, y: float, **more: Any) -> Row:
    """Return one point."""
    return {"panel": panel, "series": series, "x": x, "y": y, **more}


def curve(panel: str, series: str, x: Iterable[float], y: Iterable[float]) -> list[Row]:
    """Return the points of a curve."""
    return [point(panel, series, *at) for at in zip(x, y, strict=True)]


def frame_of(corpus: str, rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return points as the table `endres_figure`."""
    frame = pd.DataFrame(rows, columns=tables.TABLES["endres_figure"].names()[1:])
    frame["label"] = frame["label"].astype(object).fillna("")
    frame.insert(0, "corpus", corpus)
    return frame


def panel_of(frame: pd.DataFrame, name: str) -> pd.DataFrame:
    """Return the points of one panel."""
    return frame[frame["panel"] == name]


def group(
    table: pd.DataFrame, dataset: str, true_order: int | None = None, *, signer: str = ALL,
    sign: str = ALL,
) -> pd.DataFrame:  # fmt: skip
    """Return the rows of one group of trajectories; all of a dataset unless told."""
    here = (table["dataset"] == dataset) & (table["signer"] == signer) & (table["sign"] == sign)
    if true_order is not None:
        here &= table["true_order"] == true_order
    return table[here]


def pooled_and_signers(table: pd.DataFrame, dataset: str) -> list[tuple[str, pd.DataFrame]]:
    """Return all trajectories, and where there are few groups, each of them, with their names."""
    out = [("all", group(table, dataset))]
    mine = table[(table["dataset"] == dataset) & (table["signer"] != ALL)]
    keys = list(mine.groupby(["signer", "sign"]).groups)
    if 1 < len(keys) <= 4:
        out += [
            (f"{signer}, {sign}", group(table, dataset, signer=signer, sign=sign))
            for signer, sign in keys
        ]
    return out


def order_points(posteriors: pd.DataFrame, panel: str, series: str) -> list[Row]:
    """Return the points of an order posterior. posteriors: rows of `order_posteriors`."""
    return [
        point(panel, series, row.order, row.mean_probability, y_error=row.se)
        for row in posteriors.itertuples()
    ]


def hit_points(rates: pd.DataFrame, panel: str, series: str) -> list[Row]:
    """Return the points of hit rates over false positives. rates: rows of `hit_rates`."""
    return [
        point(
            panel, series, row.false_positives_per_s, row.hit_rate,
            x_error=row.false_positives_per_s_se, y_error=row.hit_rate_se, label=f"{row.order}",
        )
        for row in rates.itertuples()
        if pd.notna(row.hit_rate)
    ]  # fmt: skip


def chance_points(lines: pd.DataFrame, panel: str) -> list[Row]:
    """Return the points of a chance line. lines: rows of `chance_lines` of one group."""
    columns = {
        "chance": "hit_rate", "chance low": "hit_rate_low", "chance high": "hit_rate_high",
        "closed form": "closed_form",
    }  # fmt: skip
    out = []
    for series, column in columns.items():
        across = "rate_per_s" if series == "closed form" else "false_positives_per_s"
        out += curve(panel, series, lines[across], lines[column])
    return out


def told_orders(orders: Iterable[Any]) -> str:
    """Return `orders 0 to 7`, `orders 0, 3 and 6` or `order 3` for a column of orders."""
    found = sorted({int(order) for order in orders})
    if len(found) < 2:
        return f"order {found[0]}" if found else "no order"
    if len(found) > 2 and found == list(range(found[0], found[-1] + 1)):
        return f"orders {found[0]} to {found[-1]}"
    return f"orders {', '.join(map(str, found[:-1]))} and {found[-1]}"
