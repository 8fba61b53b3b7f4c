"""A claim under the readings that keep all that is printed: does it depend on what is not?"""

from __future__ import annotations

import pandas as pd

from signkin.audit.expressions import evaluate
from signkin.audit.paper import Curve
from signkin.audit.registry import Missing, OnCorpus
from signkin.audit.verdicts import AcrossReadings, Verdict, across
from signkin.errors import SignkinError


def under_readings(curve: Curve, context: OnCorpus) -> AcrossReadings | None:
    """Return what the specifications that keep the print say; None where a corpus has none.

    What the claim says of each level of a choice (`each`) is one reading: so only if all are.
    Without `keeps` a curve has no say in a verdict (None).
    """
    if not curve.keeps:
        return None
    try:
        table = context.table(curve.table)
        if "corpus" in table.columns:
            table = table[table["corpus"] == context.evidence.name]
        for condition in filter(None, (curve.where, curve.keeps)):
            table = table[evaluate(condition, {str(c): table[c] for c in table.columns})]
        table = table[table[curve.estimate].notna()]
        columns = {str(c): table[c] for c in table.columns}
        answers = evaluate(curve.holds or "holds", columns)
        against = evaluate(curve.fails, columns) if curve.fails else None
    except (Missing, SignkinError, KeyError):  # an older table, without these columns
        return None
    if table.empty or not set(curve.choices) <= set(table.columns):
        return None
    so = answers.astype(str).isin(["True", "yes", "1"])
    not_so = ~so if against is None else against.astype(bool) & ~so
    choices = {column: label for column, label in curve.choices.items() if column != curve.each}
    names = [
        ", ".join(f"{label} {value}" for label, value in zip(choices.values(), row, strict=True))
        for row in table[list(choices)].itertuples(index=False)
    ]
    if not curve.each:  # rows that differ in no choice named here are readings of their own
        names = [f"{name} (row {i + 1})" if names.count(name) > 1 else name
                 for i, name in enumerate(names)]  # fmt: skip
    by_reading = pd.Series(names, index=so.index)
    whole = so.groupby(by_reading, sort=False).all()
    none = not_so.groupby(by_reading, sort=False).any()
    found = across(
        {
            str(name): Verdict.HOLDS if whole[name]
            else Verdict.FAILS if none[name]
            else Verdict.UNDECIDED
            for name in whole.index
        }
    )  # fmt: skip
    if found.verdict == Verdict.DEPENDS and not {Verdict.HOLDS, Verdict.FAILS} <= set(
        found.by_verdict
    ):  # what is undecided under a reading contradicts none
        return AcrossReadings(Verdict.UNDECIDED, found.by_verdict)
    return found
