"""What the pages say of analyses that could not be made."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd


def unavailable_lines(rows: pd.DataFrame) -> Iterator[str]:
    """Yield a sentence an analysis, or part of one; rows: of the table `not_available`."""
    for reason, same in rows.groupby("reason", sort=False):
        parts = [
            f"{row.analysis}, {row.part}" if row.part else str(row.analysis)
            for row in same.itertuples()
        ]
        yield f"{'; '.join(parts)}: not available: {reason}"
