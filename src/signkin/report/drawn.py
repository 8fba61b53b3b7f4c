"""A drawn figure with the numbers in it and what its caption tells."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd
from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure with the numbers in it and the facts its caption tells."""

    figure: Figure
    data: pd.DataFrame
    caption: str
