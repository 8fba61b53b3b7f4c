"""What a look at a recording says: a measure, what is usual, and what to do."""

from __future__ import annotations

from dataclasses import dataclass

# In the order in which they are worth looking at. `wrong`: results would be wrong. `look`: may be
# as it should, a person must look. `fine`. `not testable`: why stands in `todo`.
LEVELS = ("wrong", "look", "fine", "not testable")


@dataclass(frozen=True)
class Notice:
    """One check of one recording.

    check: its name. level: one of LEVELS. value, unit: what was measured. usual: what is, in words.
    todo: what to do, or why it cannot be tested; empty where all is fine.
    """

    check: str
    level: str
    value: float
    unit: str
    usual: str
    todo: str = ""


def judged(
    check: str, value: float, unit: str, usual: str, bad: bool, todo: str, level: str = "look"
) -> Notice:
    """Return a notice of a level where it is bad, else a fine one."""
    return Notice(check, level if bad else "fine", value, unit, usual, todo if bad else "")


def untestable(check: str, why: str) -> Notice:
    """Return the notice of a check that cannot be made."""
    return Notice(check, "not testable", float("nan"), "", "", why)
