"""Fig. 10: mean duration by the number of hands of the signs before and after."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import hands
from signkin.report.drawn import Drawn
from signkin.statistics import descriptive


def drawn(corpus: str, rows: pd.DataFrame, published: pd.DataFrame) -> Drawn:
    """Draw a bar a change of hands. rows: counted transitions. published: Table 2 as printed."""
    groups = data(corpus, rows, published)
    typed = rows[rows["type"] != ""]
    return Drawn(draw(groups, typed), groups, caption(typed))


def data(corpus: str, rows: pd.DataFrame, published: pd.DataFrame) -> pd.DataFrame:
    """Return the table `fig10`: means by change of hands, ours and the paper's."""
    groups = descriptive.hand_changes(rows, published)
    groups.insert(0, "corpus", corpus)
    return groups


def draw(groups: pd.DataFrame, typed: pd.DataFrame) -> Figure:
    """Draw the means, and the single transitions behind them."""
    changes = typed["type"].map(descriptive.hand_change)
    durations = pd.DataFrame({"change": changes, "duration_s": typed["duration_s"]})
    figure, ax = plt.subplots(figsize=(5.4, 3.3))
    hands.plot_hand_changes(groups, durations, ax=ax)
    return figure


def caption(typed: pd.DataFrame) -> str:
    """Tell what is counted, and where the signs' types come from."""
    sources = typed["type_source"].value_counts().to_dict()
    told = ", ".join(f"{n} {source}" for source, n in sorted(sources.items()))
    return (
        f"Mean duration by the number of hands of the signs before and after (type 2 counts as "
        f"two-handed), manual tags, whole body; n = {len(typed)}. Types from: {told} (kinematic: "
        "inferred from motion). Orange: the paper's means, weighted from its Table 2."
    )
