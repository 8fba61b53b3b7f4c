"""What Snakemake sees of a rule's params when it asks whether they have changed."""

from __future__ import annotations

from typing import Any, Protocol

# What Snakemake compares (its Persistence, `_serialize_param_builtin`); anything else it passes
# over without a word.
COMPARED = (int, float, bool, str, complex, range, list, tuple, dict, set, frozenset, bytes,
            bytearray)  # fmt: skip


class Params(Protocol):
    """A rule's params: names and values."""

    def items(self) -> Any:
        """Return pairs of names and values."""


def told_as_text(params: Params) -> str:
    """Return the params that Snakemake does not compare as text; empty where there are none.

    params: of a rule as written, so that functions of wildcards, which are to return what is
    compared, are not called.
    """
    return "; ".join(
        f"{name}={value!r}"
        for name, value in params.items()
        if value is not None and not callable(value) and not isinstance(value, COMPARED)
    )
