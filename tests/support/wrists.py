"""Boundaries, minima and tags of two small recordings, with known times."""

import pandas as pd

FOUND_S = {
    ("a", "right"): [0.50, 1.04, 2.00, 2.90], ("b", "right"): [0.30, 1.00],
    ("a", "left"): [1.00], ("b", "left"): [],
}  # fmt: skip
MINIMA_S = {
    ("a", "right"): [0.55, 1.50], ("b", "right"): [0.95], ("a", "left"): [2.5], ("b", "left"): [],
}  # fmt: skip
# One sign of a ends where the next one starts, at 1.0 s.
TAGS = [("a", "start", 0.58, 0.55), ("a", "end", 1.0, 1.0), ("a", "start", 1.0, 1.5),
        ("a", "end", 2.5, 2.5), ("b", "start", 0.6, 0.6), ("b", "end", 1.05, 0.95)]  # fmt: skip
DURATIONS = {"a": 4.0, "b": 2.0}


def tables_of_events():
    def rows(times, column):
        return pd.DataFrame(
            [(r, h, t) for (r, h), many in times.items() for t in many],
            columns=["recording", "hand", column],
        )

    tags = pd.DataFrame(
        [(r, h, e, m, f) for r, e, m, f in TAGS for h in ("right", "left")],
        columns=["recording", "hand", "edge", "manual_s", "refined_s"],
    )
    about = pd.DataFrame({"recording": list(DURATIONS), "duration_s": list(DURATIONS.values())})
    posteriors = pd.DataFrame(list(FOUND_S), columns=["recording", "hand"])
    return about, posteriors, rows(FOUND_S, "boundary_s"), rows(MINIMA_S, "minimum_s"), tags
