"""The checks on print, a file a subject; importing the package registers them all."""

from signkin.audit.checks import groups, numbers, tables

__all__ = ["groups", "numbers", "tables"]
