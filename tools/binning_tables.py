"""The tables of docs/interpretations.md that tools/binning.py works out the numbers of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tools.numbers import table

MOST = 40  # recordings of a corpus
ORDERS = tuple(range(8))
SHIPPED = "as shipped"


@dataclass(frozen=True)
class Outcome:
    """What a variant does to a corpus: M at orders 0, 3, 7, and the order posteriors.

    truths: trajectories with ground truth; rates: hit rate and false positives a second of
    theirs at order 3, as text; left: recorded trajectories of left hands.
    """

    counts: tuple[float, ...]
    posterior: NDArray[np.float64]
    truths_posterior: NDArray[np.float64] | None
    rates: str
    recorded: int
    truths: int
    left: int

    @property
    def peak(self) -> str:
        """The order with the most probability, recorded movements."""
        return str(int(np.argmax(self.posterior)))

    @property
    def truths_peak(self) -> str:
        """The order with the most probability, ground truth."""
        found = self.truths_posterior
        return "none" if found is None else str(int(np.argmax(found)))

    @property
    def middle(self) -> str:
        """P(3 <= S <= 5)."""
        return f"{self.posterior[3:6].sum():.2f}"

    def m(self, form: str = ".1f") -> str:
        """M at orders 0, 3 and 7."""
        return ", ".join(format(count, form) for count in self.counts)


def by_variant(found: Mapping[str, Mapping[str, Outcome]]) -> dict[str, str]:
    """Return the tables of variants of single signs. found: by corpus and variant."""
    head = ("", *found)
    kept = {"**sensor**": SHIPPED, "data": "prior.noise data"}
    noise = {**kept, "noise_sd halved": "noise_sd halved", "noise_sd doubled": "noise_sd doubled"}
    bins = {"50 bins": "bins 50", "**100**": SHIPPED, "200": "bins 200"}
    units = {
        "**bin, b = 0.1**": SHIPPED, "bin, 0.001": "prior.concentration 0.001",
        "bin, 10": "prior.concentration 10", "second": "prior.time_unit second",
        "trajectory": "prior.time_unit trajectory",
    }  # fmt: skip
    corpora = list(found.values())
    rows = [
        [label, *(f"{of[key].m()}; {of[key].rates}" for of in corpora)]
        for label, key in noise.items()
    ]
    peaks = (", ".join(of[key].peak for key in kept.values()) for of in corpora)
    rows.insert(2, ["peak: sensor, data", *peaks])
    of_isl = {label: found["isl-sim"][key] for label, key in units.items()}
    return {
        "binning-noise": table(head, rows),
        "binning-bins": table(
            ("M; peak", *found),
            (
                [label, *(f"{of[key].m()}; {of[key].peak}" for of in corpora)]
                for label, key in {**bins, "rest not left out": "rest not left out"}.items()
            ),
        ),
        "binning-concentration": table(
            (f"isl-sim, {MOST} recordings", "M", "peak; P(3-5)", "truth's peak",
             "order 3: hit rate, false pos./s"),
            (
                [label, one.m(), f"{one.peak}; {one.middle}", one.truths_peak, one.rates]
                for label, one in of_isl.items()
            ),
        ),
    }  # fmt: skip


def of_many_dof(found: Mapping[str, Mapping[str, Outcome]]) -> str:
    """Return the table of degrees of freedom."""
    rows = (
        [
            dof,
            *(
                f"{o.m('.2g')}; {o.peak}, {o.truths_peak}"
                for o in (of[dof] for of in found.values())
            ),
        ]
        for dof in next(iter(found.values()))
    )
    return table(("nu", f"{next(iter(found))}: M; peak, truth's", *list(found)[1:]), rows)


def of_recovery(found: Mapping[tuple[str, float, float], list[str]], kind: str) -> str:
    """Return the table of one kind of fitted trajectories."""
    shares = {
        "share 1": (0.1, 1.0), "**0.1**": (0.1, 0.1), "0.0125": (0.1, 0.0125),
        "0.1, b = 0.001": (0.001, 0.1),
    }  # fmt: skip
    head = (kind, *(f"order {order}" for order in ORDERS[1:]))
    return table(head, ([label, *found[kind, *key]] for label, key in shares.items()))


def of_picking(found: Mapping[str, Mapping[str, list[str]]]) -> str:
    """Return the table of the ways to take boundaries from the posterior."""
    names = ("isl-sim", "isl-kinect")
    head = ("", *(f"{name}, order {order}" for name in names for order in (0, 3)))
    ways = found[names[0]]
    return table(head, ([way, *(c for name in names for c in found[name][way])] for way in ways))
