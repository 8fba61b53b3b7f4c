"""Descriptive statistics of durations: Table 2, Fig. 8 and Fig. 10 of Naert et al. 2017.

Arrays and data frames in, data frames out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import decimals

SIGN_TYPES = ("00", "10", "11", "20")
TYPES = tuple(a + b for a, b in product(SIGN_TYPES, repeat=2))
CHANGES = ("1H to 1H", "1H to 2H", "2H to 1H", "2H to 2H")
Times = Sequence[Fraction]  # exact durations in seconds
ABSENT = "/"  # what the paper prints for a type without transitions


def outliers(durations_s: NDArray[np.float64], fences_iqr: float) -> NDArray[np.bool_]:
    """Mark durations more than `fences_iqr` interquartile ranges outside the quartiles (Tukey)."""
    if not len(durations_s):
        return np.zeros(0, dtype=bool)
    low, high = np.quantile(durations_s, [0.25, 0.75])
    reach = fences_iqr * (high - low)
    return (durations_s < low - reach) | (durations_s > high + reach)


def table2(
    transitions: pd.DataFrame, is_outlier: NDArray[np.bool_], published: pd.DataFrame
) -> pd.DataFrame:
    """Return number, mean and SD of the durations by type, printed as in the paper's Table 2.

    transitions: one row a transition, with `type` and `duration_s`. is_outlier: (N,).
    published: papers/naert2017/table2.csv, all text. Means and SDs are exact (fractions) and
    rounded half up, to the published number of decimals where the paper has the row, else to
    five significant digits, which is what the paper prints.
    """
    paper = published.set_index("type")
    others = sorted(set(transitions["type"]) - set(TYPES) - {""})
    rows = []
    for kind in (*TYPES, *others, "all"):
        chosen = np.full(len(transitions), True)
        if kind != "all":
            chosen = (transitions["type"] == kind).to_numpy()
        durations = [decimals.exact(d) for d in transitions.loc[chosen, "duration_s"]]
        outlying = is_outlier[chosen]
        kept = [d for d, out in zip(durations, outlying, strict=True) if not out]
        printed_in_paper = paper.loc[kind].to_dict() if kind in paper.index else {}
        row: dict[str, object] = {"type": kind}
        row |= _numbers(durations, "")
        row |= _numbers(kept, "_without_outlier") if len(kept) < len(durations) else {}
        row |= _printed(durations, kept, printed_in_paper)
        row |= {f"published_{key}": _joined(printed_in_paper, key) for key in ("n", "mean", "sd")}
        same = all(row[f"printed_{key}"] == row[f"published_{key}"] for key in ("n", "mean", "sd"))
        row["equal"] = ("yes" if same else "no") if printed_in_paper else ""
        row["note"] = _note(durations)
        rows.append(row)
    columns = ["type", "n", "mean_s", "sd_s", "n_without_outlier", "mean_without_outlier_s",
               "sd_without_outlier_s", "printed_n", "printed_mean", "printed_sd", "published_n",
               "published_mean", "published_sd", "equal", "note"]  # fmt: skip
    return pd.DataFrame(rows).reindex(columns=columns)


def _numbers(durations: Times, suffix: str) -> dict[str, float]:
    n = len(durations)
    return {
        f"n{suffix}": n,
        f"mean{suffix}_s": float(decimals.mean(durations)) if n else np.nan,
        f"sd{suffix}_s": float(decimals.variance(durations)) ** 0.5 if n > 1 else np.nan,
    }


def _note(durations: Times) -> str:
    if not durations:
        return "no transition of this type"
    if len(durations) == 1:
        return "one value: n - 1 leaves the SD undefined; printed as 0, as the paper does"
    return ""


def _printed(durations: Times, kept: Times, paper: Mapping[str, str]) -> dict[str, str]:
    without = len(kept) < len(durations)
    out = {}
    for key, printer in (("n", lambda d, _: str(len(d))), ("mean", _mean), ("sd", _sd)):
        out[key] = printer(durations, _model(paper, key, ""))
        if without:
            out[key] += f" ({printer(kept, _model(paper, key, '_without_outlier'))})"
    return {f"printed_{key}": text for key, text in out.items()}


def _model(paper: Mapping[str, str], key: str, suffix: str) -> str:
    """Return the print that sets the number of decimals; '' for none.

    The paper prints 0 for the SD of one value, which has none: no SD has its decimals.
    """
    if key == "sd" and paper.get(f"n{suffix}") == "1":
        return ""
    return paper.get(f"{key}{suffix}", "")


def _mean(durations: Times, printed: str) -> str:
    if not durations:
        return ABSENT
    value = decimals.mean(durations)
    return decimals.fixed(value, _places(float(value), printed))


def _sd(durations: Times, printed: str) -> str:
    if not durations:
        return ABSENT
    if len(durations) == 1:
        return "0"
    value = decimals.variance(durations)
    return decimals.fixed_root(value, _places(float(value) ** 0.5, printed))


def _places(value: float, printed: str) -> int:
    if printed and printed != ABSENT:
        return decimals.places_of(printed)
    return decimals.places_for(value)


def _joined(paper: Mapping[str, str], key: str) -> str:
    if not paper:
        return ""
    without = paper[f"{key}_without_outlier"]
    return f"{paper[key]} ({without})" if without else str(paper[key])


# --- Fig. 8 ----------------------------------------------------------------------------------


# Above this many points that may be left out, bounds are tried on a grid of as many steps.
MOST_CUTS = 60


@dataclass(frozen=True, eq=False)
class Diamond:
    """A box standing on its corner: its four corners by name, (x, y), and what it holds."""

    corners: dict[str, tuple[float, float]]
    inside: NDArray[np.bool_]

    @property
    def share(self) -> float:
        """Share of the points inside or on the edge."""
        return float(self.inside.mean())


def diamond(x: NDArray[np.float64], y: NDArray[np.float64], share: float = 0.9) -> Diamond:
    """Return the smallest diamond that holds more than a share of the points.

    The paper prints neither corners nor a rule (Fig. 8). Here the four sides have two slopes,
    plus and minus the interquartile range of y over that of x, and among all such boxes with
    more than `share` of the points the one with the least area is taken.
    """
    n = len(x)
    scale = [float(np.subtract(*np.quantile(v, [0.75, 0.25]))) or 1.0 for v in (x, y)]
    rising = x / scale[0] + y / scale[1]
    falling = x / scale[0] - y / scale[1]
    spare = n - min(n, int(np.floor(share * n)) + 1)
    order = np.argsort(rising, kind="stable")
    # Sorted once: of 60,000 points a sort for each of 1,900 pairs of cuts would take seconds.
    by_falling = np.argsort(falling, kind="stable")
    rank = np.empty(n, dtype=np.intp)
    rank[order] = np.arange(n)
    falling_sorted, rank_sorted = falling[by_falling], rank[by_falling]
    cuts = range(0, spare + 1, max(1, spare // MOST_CUTS))
    best = (np.inf, 0.0, 0.0, 0.0, 0.0)
    for below in cuts:
        for above in cuts:
            if below + above > spare:
                break
            low, high = rising[order[below]], rising[order[n - above - 1]]
            across = falling_sorted[(rank_sorted >= below) & (rank_sorted < n - above)]
            width = across[n - spare - 1 :] - across[: len(across) - (n - spare) + 1]
            first = int(np.argmin(width))
            area = (high - low) * width[first]
            if area < best[0]:
                best = (area, low, high, across[first], across[first] + width[first])
    _, r0, r1, f0, f1 = best

    def corner(r: float, f: float) -> tuple[float, float]:
        return scale[0] * (r + f) / 2, scale[1] * (r - f) / 2

    corners = {
        "left": corner(r0, f0),
        "top": corner(r1, f0),
        "right": corner(r1, f1),
        "bottom": corner(r0, f1),
    }
    edge = 1e-12 * max(1.0, float(np.abs(rising).max()), float(np.abs(falling).max()))
    inside = (np.abs(rising - (r0 + r1) / 2) <= (r1 - r0) / 2 + edge) & (
        np.abs(falling - (f0 + f1) / 2) <= (f1 - f0) / 2 + edge
    )
    return Diamond(corners, inside)


# --- Fig. 10 ---------------------------------------------------------------------------------


def hand_change(kind: str) -> str:
    """Return `1H to 2H` for a four-digit type; type 2 counts as two-handed (Fig. 10)."""
    hands = ["1H" if kind[i] == "0" else "2H" for i in (0, 2)]
    return f"{hands[0]} to {hands[1]}"


def hand_changes(transitions: pd.DataFrame, published: pd.DataFrame) -> pd.DataFrame:
    """Return number, mean and SD of durations by change of hands, beside the paper's means.

    The paper's means are weighted from its Table 2; its bars print no numbers.
    """
    typed = transitions[transitions["type"] != ""]
    changes = typed["type"].map(hand_change)
    filled = published[published["n"] != "0"]
    paper_changes = filled["type"].map(hand_change)
    paper_n = pd.to_numeric(filled["n"])
    paper_sum = paper_n * pd.to_numeric(filled["mean"])
    rows = []
    for change in CHANGES:
        durations = typed.loc[changes == change, "duration_s"]
        weight = int(paper_n[paper_changes == change].sum())
        rows.append(
            {
                "change": change,
                "n": len(durations),
                "mean_s": durations.mean() if len(durations) else np.nan,
                "sd_s": durations.std(ddof=1) if len(durations) > 1 else np.nan,
                "published_n": weight,
                "published_mean_s": paper_sum[paper_changes == change].sum() / weight,
            }
        )
    return pd.DataFrame(rows)


@dataclass(frozen=True)
class Trend:
    """A straight line y = intercept + slope x with Pearson's correlation."""

    slope: float
    intercept: float
    r: float
    n: int


def trend(x: NDArray[np.float64], y: NDArray[np.float64]) -> Trend | None:
    """Return the least-squares line, or None where x or y does not vary."""
    if len(x) < 3 or np.ptp(x) == 0 or np.ptp(y) == 0:
        return None
    slope, intercept = np.polyfit(x, y, 1)
    return Trend(float(slope), float(intercept), float(np.corrcoef(x, y)[0, 1]), len(x))
