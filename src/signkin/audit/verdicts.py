"""The levels of a verdict, and how evidence becomes one of them: no sharper than it is.

A claim holds or fails only where the interval of what it is about lies on one side; else it is
undecided. Where readings of what is not printed disagree, it depends; where the data were made
with the printed number, agreement is by construction.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from scipy import stats

from signkin.errors import SignkinError, listed


class Verdict(StrEnum):
    """What is said of a claim."""

    CONSISTENT = "consistent"  # the print allows it
    INCONSISTENT = "inconsistent"  # the print contradicts itself
    HOLDS = "holds"
    FAILS = "fails"
    UNDECIDED = "undecided"  # the data allow both
    DEPENDS = "depends"  # on what is not printed
    BY_CONSTRUCTION = "by construction"  # the data were made with the printed number
    NOT_TESTABLE = "not testable"


def from_interval(low: float, high: float, bound: float = 0.0) -> Verdict:
    """Return the verdict on `it is above the bound`, by the interval of what it is about.

    With a two-sided interval of 1 - alpha, at the bound itself `holds` and `fails` come out in
    alpha / 2 of cases each. NaN is not testable; low above high is an error.
    """
    if low != low or high != high:
        return Verdict.NOT_TESTABLE
    if low > high:
        raise SignkinError(
            f"the interval goes from {low:g} to {high:g}", place="verdict", expected="low <= high"
        )
    if low > bound:
        return Verdict.HOLDS
    return Verdict.FAILS if high < bound else Verdict.UNDECIDED


def from_probability(probability: float, level: float = 0.95) -> Verdict:
    """Return the verdict on something that is so with a (bootstrap) probability.

    Two-sided as `from_interval`: holds above 1 - (1 - level) / 2, fails below (1 - level) / 2.
    """
    if probability != probability:
        return Verdict.NOT_TESTABLE
    if not 0 <= probability <= 1:
        raise SignkinError(f"a probability of {probability:g}", place="verdict", expected="0 to 1")
    edge = (1 - level) / 2
    if probability > 1 - edge:
        return Verdict.HOLDS
    return Verdict.FAILS if probability < edge else Verdict.UNDECIDED


def more_than_luck(below: int, rows: int, level: float = 0.95) -> bool:
    """Return whether so many of the rows lie below an interval of chance more than by luck.

    Each lies there in (1 - level) / 2 of cases; one of eight does so too often to mean anything.
    Rows are taken as independent.
    """
    if below < 1:
        return False
    return bool(stats.binom.sf(below - 1, rows, (1 - level) / 2) < 1 - level)


@dataclass(frozen=True)
class AcrossReadings:
    """A claim under all readings of what is not printed.

    verdict: the one that all testable readings give, or depends. by_verdict: verdict -> the
    readings that give it.
    """

    verdict: Verdict
    by_verdict: Mapping[Verdict, tuple[str, ...]]

    def share(self, verdict: Verdict) -> float:
        """Return the share of testable readings that give a verdict; NaN where none is testable."""
        tested = sum(len(v) for k, v in self.by_verdict.items() if k is not Verdict.NOT_TESTABLE)
        return len(self.by_verdict.get(verdict, ())) / tested if tested else float("nan")

    def why(self, most: int = 3) -> str:
        """Return which readings give what, `most` of them by name."""
        total = sum(map(len, self.by_verdict.values()))
        return "; ".join(
            f"{verdict} under {len(names)} of {total} readings ({listed(list(names), most)})"
            for verdict, names in self.by_verdict.items()
        )


def across(readings: Mapping[str, Verdict]) -> AcrossReadings:
    """Return one verdict for a claim under several readings. readings: name -> verdict.

    Raises SignkinError for no reading.
    """
    if not readings:
        raise SignkinError("no reading", place="verdict", expected="one or more")
    by_verdict: dict[Verdict, tuple[str, ...]] = {}
    for name, verdict in readings.items():
        by_verdict[verdict] = (*by_verdict.get(verdict, ()), name)
    tested = set(by_verdict) - {Verdict.NOT_TESTABLE}
    if not tested:
        return AcrossReadings(Verdict.NOT_TESTABLE, by_verdict)
    verdict = tested.pop() if len(tested) == 1 else Verdict.DEPENDS
    return AcrossReadings(verdict, by_verdict)


def of_simulation(verdict: Verdict, made_with_the_print: bool) -> Verdict:
    """Return the verdict on a simulated corpus: no evidence where it was made with the print.

    A claim that fails even there stays failed: it tells of the method.
    """
    agrees = verdict in (Verdict.HOLDS, Verdict.CONSISTENT)
    return Verdict.BY_CONSTRUCTION if made_with_the_print and agrees else verdict
