"""How often each rule of a verdict says `holds` or `fails` where neither is so, by simulation.

python -m tools.verdict_levels [CASES]

At the bound itself a two-sided rule of 95 % may say either in 2.5 % of cases each. Rows come from
8 signers with 5 signs each, which share what a signer and a sign do (half of the variance). A
second table: what a clustered mean errs and finds with the signers and signs of corpora.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from signkin.audit.ledger import CORPUS
from signkin.audit.registry import Evidence, OnCorpus
from signkin.resampling import difference
from tools.numbers import table

SIGNERS, SIGNS = 8, 5
CLUSTERED: dict[str, Any] = {"table": "t", "unit": ["recording"], "clusters": ["signer", "sign"]}
# Signers, signs and repetitions; shifts in SDs of a recording; shares of the variance.
DESIGNS = {"isl-sim": (2, 2, 20), "as above": (8, 5, 1), "isl-kinect": (10, 5, 9)}
SHIFTS = (0.0, 0.5, 1.0, 2.0)
SHARES = {"half of signer and sign": (0.25, 0.25), "none": (0.0, 0.0), "most of sign": (0.05, 0.75)}
Make = Callable[[np.random.Generator], pd.DataFrame]


def recordings(rng: np.random.Generator) -> pd.DataFrame:
    """Return a number of mean 0 for orders 2 to 4 of each recording; all orders tie."""
    signer, sign = rng.normal(0, 0.5, (SIGNERS, 1, 3)), rng.normal(0, 0.5, (1, SIGNS, 3))
    x = signer + sign + rng.normal(0, 0.7, (SIGNERS, SIGNS, 3))
    index = [(f"s{i}", f"g{j}", k + 2) for i, j, k in np.ndindex(x.shape)]
    frame = pd.DataFrame(index, columns=["signer", "sign", "order"]).assign(p=x.ravel())
    return frame.assign(recording=frame["signer"] + frame["sign"])


def pairs(rng: np.random.Generator) -> pd.DataFrame:
    """Return 60 pairs without a correlation, and a number that differs between no kinds."""
    return pd.DataFrame(
        {"x": rng.normal(size=60), "y": rng.normal(size=60), "kind": np.arange(60) % 3,
         "row": np.arange(60)}
    )  # fmt: skip


def kinds(rng: np.random.Generator) -> pd.DataFrame:
    """Return n, mean and SD of two groups of 20 with one mean."""
    x = rng.normal(0.3, 0.1, (2, 20))
    return pd.DataFrame(
        {"kind": ["a", "b"], "mean": x.mean(axis=1), "sd": x.std(axis=1, ddof=1), "n": [20, 20]}
    )


def near(rng: np.random.Generator) -> pd.DataFrame:
    """Return shares of 100 tags of one hand that are near by chance alone, under three nulls."""
    value, chance = rng.binomial(100, 0.6) / 100, rng.binomial(100, 0.6, (3, 1000)) / 100
    low, high = np.quantile(chance, [0.025, 0.975], axis=1)
    return pd.DataFrame(
        {"null": ["a", "b", "c"], "hand": "right", "value": value, "chance": chance.mean(axis=1),
         "chance_low": low, "chance_high": high}
    )  # fmt: skip


def rows_by_chance(rng: np.random.Generator) -> pd.DataFrame:
    """Return eight independent rows of such shares."""
    return pd.concat([near(rng).head(1).assign(order=order) for order in range(8)])


RULES: dict[str, tuple[str, Make, Mapping[str, Any]]] = {
    "a mean at its bound, clustered": (
        "mean_of", recordings, {**CLUSTERED, "value": "p", "above": "0"}),
    "a peak among three that tie, clustered": (
        "ranked", recordings, {**CLUSTERED, "key": "order", "value": "p", "highest": [3]}),
    "an order of two that tie, clustered": (
        "ranked", recordings, {**CLUSTERED, "key": "order", "value": "p", "below": [[2], [3]]}),
    "a median at its bound, rows independent": (
        "measure", pairs, {"table": "t", "value": "x", "take": "median", "at_least": "0"}),
    "a correlation of 0": ("correlation", pairs, {"table": "t", "x": "x", "y": "y"}),
    "two groups with one mean": (
        "order", kinds, {"table": "t", "key": "kind", "value": "mean", "sd": "sd", "n": "n",
                         "below": [["a"], ["b"]]}),
    "three groups with one mean, `differ: true`": (
        "groups_differ", pairs, {"table": "t", "value": "x", "by": "kind", "differ": True}),
    "a mean at its bound, rows independent": (
        "mean_of", pairs, {"table": "t", "value": "x", "unit": ["row"], "above": "0"}),
    "a mean that is the printed one": (
        "measure", pairs, {"table": "t", "value": "x", "take": "mean", "contains": "0.00"}),
    "three groups with one mean, `differ: false`": (
        "groups_differ", pairs, {"table": "t", "value": "x", "by": "kind", "differ": False}),
    "a share that chance gives, three nulls": (
        "against_nulls", near, {"table": "t", "by": ["hand"]}),
    "a share that chance gives, eight rows": (
        "beyond_chance", rows_by_chance, {"table": "t", "by": ["order"], "value": "value",
                                          "low": "chance_low", "high": "chance_high"}),
}  # fmt: skip


def said(
    check: str, make: Make, arguments: Mapping[str, Any], cases: int, seed: int
) -> Counter[str]:
    """Return how often a rule says what."""
    rng = np.random.default_rng(seed)

    class Made(OnCorpus):
        """A corpus whose only table is drawn anew each time."""

        def table(self, name: str) -> pd.DataFrame:
            return make(rng)

        def source(self, name: str) -> str:
            return name

        def text(self, name: object) -> str:
            return str(name)

    nothing: Any = type("Claim", (), {"id": "C", "printed": {}})()
    out: Counter[str] = Counter()
    for case in range(cases):
        # The bootstrap's stream hangs on the corpus's name: one of its own for each case.
        context = Made(nothing, nothing, Evidence(f"made {case}", True))
        out.update(finding.verdict for finding in CORPUS[check](context, **arguments))
    return out


def levels(cases: int) -> str:
    """Return the rates as a table."""
    rows = []
    for seed, (name, (check, make, arguments)) in enumerate(RULES.items()):
        found = said(check, make, arguments, cases, seed)
        rates = (
            f"{100 * found[v] / cases:.1f} %" for v in ("holds", "fails", "undecided", "depends")
        )
        rows.append((name, f"`{check}`", *rates))
        print(rows[-1], flush=True)
    return table(("nothing is so", "check", "holds", "fails", "undecided", "depends"), rows)


def clustered(cases: int) -> str:
    """Return how often a clustered mean errs, and how often it finds a shift, by design."""
    rows = []
    for (design, sizes), (shares, (of_signer, of_sign)) in product(DESIGNS.items(), SHARES.items()):
        said: Counter[float] = Counter()
        for case in range(cases):
            rng = np.random.default_rng([case, *sizes])
            who, what, _ = (axis.ravel() for axis in np.indices(sizes))
            x = (
                np.sqrt(of_signer) * rng.normal(size=sizes[0])[who]
                + np.sqrt(of_sign) * rng.normal(size=sizes[1])[what]
                + np.sqrt(1 - of_signer - of_sign) * rng.normal(size=len(who))
            )
            kinds = {"signer": who.tolist(), "sign": what.tolist()}
            found = difference(x, np.zeros(len(x)), kinds, 400, rng)
            said.update(shift for shift in SHIFTS if found.low + shift > 0)
            said[-1.0] += found.high < 0
        rates = (f"{100 * said[shift] / cases:.1f} %" for shift in (-1.0, *SHIFTS))
        rows.append((f"{design}: {' x '.join(map(str, sizes))}", shares, *rates))
        print(rows[-1], flush=True)
    found_at = (f"finds {shift:g} SD" for shift in SHIFTS[1:])
    return table(
        ("signers x signs x repetitions", "variance shared", "fails", "holds", *found_at), rows
    )


if __name__ == "__main__":
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    print(levels(number))
    print(clustered(number))
