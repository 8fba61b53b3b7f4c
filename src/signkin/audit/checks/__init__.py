"""The checks on print, a file a subject; importing the package registers them all."""

from signkin.audit.checks import (
    conversions,
    counts,
    effects,
    groups,
    lists,
    numbers,
    samples,
    tables,
    wholes,
)

__all__ = [
    "conversions",
    "counts",
    "effects",
    "groups",
    "lists",
    "numbers",
    "samples",
    "tables",
    "wholes",
]
