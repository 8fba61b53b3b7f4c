"""Fig. 10: mean duration by the number of hands of the signs before and after."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import hands
from signkin.report.drawn import Drawn
from signkin.statistics import descriptive
from signkin.tables import TABLES


def drawn(corpus: str, rows: pd.DataFrame, published: pd.DataFrame) -> Drawn:
    """Draw a bar a change of hands. rows: counted transitions. published: Table 2 as printed."""
    shown = data(corpus, rows, published)
    return Drawn(draw(shown), shown, caption(rows[rows["type"] != ""]))


def data(corpus: str, rows: pd.DataFrame, published: pd.DataFrame) -> pd.DataFrame:
    """Return the table `fig10`: means by change of hands, ours and the paper's, and each dot."""
    means = descriptive.hand_changes(rows, published).assign(kind="mean")
    typed = rows[rows["type"] != ""]
    dots = pd.DataFrame(
        {
            "kind": "transition",
            "change": typed["type"].map(descriptive.hand_change),
            "duration_s": typed["duration_s"],
        }
    )
    order = {change: i for i, change in enumerate(descriptive.CHANGES)}
    dots = dots.sort_values(
        ["change", "duration_s"], key=lambda c: c.map(order) if c.name == "change" else c
    )
    shown = pd.concat([means, dots], ignore_index=True).assign(corpus=corpus)
    for column in ("n", "published_n"):
        shown[column] = shown[column].astype("Int64")
    return shown.reindex(columns=TABLES["fig10"].names())


def draw(shown: pd.DataFrame) -> Figure:
    """Draw the rows of the table `fig10`: the means, and the single transitions behind them."""
    figure, ax = plt.subplots(figsize=(5.4, 3.3))
    hands.plot_hand_changes(
        shown[shown["kind"] == "mean"], shown[shown["kind"] == "transition"], ax=ax
    )
    return figure


def caption(typed: pd.DataFrame) -> str:
    """Tell what is counted, and where the signs' types come from."""
    sources = typed["type_source"].value_counts().to_dict()
    told = ", ".join(f"{n} {source}" for source, n in sorted(sources.items()))
    return (
        f"Mean duration by the number of hands of the signs before and after (type 2 counts as "
        f"two-handed), manual tags, whole body; n = {len(typed)}; dots are single "
        f"transitions. Types from: {told} (kinematic: "
        "inferred from motion). Orange: the paper's means, weighted from its Table 2."
    )
