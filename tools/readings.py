"""What the printed prior does when V itself, not its inverse, is the data's variances (3.2).

python -m tools.numbers RESULTS DATA readings

40 recordings of each corpus, evenly spread; b = 0.1, T = 100, time in bins.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from signkin.studies.endres2013.single_signs import Trajectory
from tools.binning import SINGLE, VARIANTS, Takes, cut, outcome, takes, with_binning
from tools.binning_tables import SHIPPED, Outcome
from tools.numbers import table
from tools.shipped import shipped

UNITS = ("mm", "cm", "m")
DEGREES = (3.0, 3.5, 4.0, 5.0, 10.0)
Reading = tuple[str, float]


def literal(of: Takes) -> dict[Reading, Outcome]:
    """Print what the literal reading does to a corpus, by unit of length and nu; returns it."""
    print(f"\n### {of.corpus.name}: V = the data's variances; recorded and ground truth\n")
    print("| unit, nu | M at 0, 3, 7 | peak | P(3-5) | truth's peak | its P | order 3: hit rate, "
          "false pos./s |")  # fmt: skip
    print("|---" * 7 + "|")
    out = {}
    trajectories = cut(of, shipped(), VARIANTS[SHIPPED])  # the prior has no part in it
    for unit in UNITS:
        for dof in DEGREES:
            one = out[unit, dof] = under(of, trajectories, unit, dof)
            print(
                f"| {unit}, {dof:g} | {one.m()} | {one.peak} ({one.posterior.max():.2f}) "
                f"| {one.middle} | {one.truths_peak} | {truths_share(one)} | {one.rates} "
                f"(n = {one.truths}) |",
                flush=True,
            )
    return out


def under(of: Takes, trajectories: list[Trajectory], unit: str, dof: float) -> Outcome:
    """Bin a corpus with the data's variances as V, in a unit of length."""
    changes = {
        "prior.noise": "data", "prior.scale": "literal", "prior.length_unit": unit,
        "prior.dof": dof,
    }  # fmt: skip
    return outcome(of, with_binning(shipped(), changes), VARIANTS[SHIPPED], trajectories)


def truths_share(of: Outcome) -> str:
    """Return the probability of the order that ground truth prefers."""
    return "none" if of.truths_posterior is None else f"{of.truths_posterior.max():.2f}"


def of_readings(found: Mapping[str, Mapping[Reading, Outcome]]) -> str:
    """Return the table of the page: M; peak, P(3-5); the peak of ground truth and its P."""
    rows = []
    for unit in UNITS:
        for dof in DEGREES:
            cells = [
                f"{o.m()}; {o.peak}, {o.middle}; {o.truths_peak} ({truths_share(o)})"
                for o in (of[unit, dof] for of in found.values())
            ]
            rows.append([f"{unit}, nu = {dof:g}", *cells])
    return table(("", *found), rows)


def main(results: Path, data: Path) -> dict[str, str]:
    """Print every table; returns that of the page."""
    there = {name: of for name in SINGLE if (of := takes(name, results, data)) is not None}
    return {"readings-literal": of_readings({name: literal(of) for name, of in there.items()})}


def sample(results: Path) -> tuple[str, str]:
    """Return a place and the start of a row of it, from simulated recordings, to compare."""
    of = takes("isl-sim", results, results)
    assert of is not None
    one = under(of, cut(of, shipped(), VARIANTS[SHIPPED]), UNITS[0], DEGREES[0])
    return "readings-literal", (
        f"| mm, nu = 3 | {one.m()}; {one.peak}, {one.middle}; {one.truths_peak} "
        f"({truths_share(one)}) |"
    )
