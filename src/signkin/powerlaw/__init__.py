"""The power law of speed and curvature (Endres et al. 2013), and ground truth that obeys it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from signkin.powerlaw.fit import PowerLaw, active_part, fit_power_law
    from signkin.powerlaw.ground_truth import (
        REASONS,
        GroundTruth,
        LeftOut,
        WarpSettings,
        warp_to_power_law,
    )

__all__ = [
    "REASONS",
    "GroundTruth",
    "LeftOut",
    "PowerLaw",
    "WarpSettings",
    "active_part",
    "fit_power_law",
    "warp_to_power_law",
]

_HOMES = {
    "REASONS": "ground_truth",
    "GroundTruth": "ground_truth",
    "LeftOut": "ground_truth",
    "PowerLaw": "fit",
    "WarpSettings": "ground_truth",
    "active_part": "fit",
    "fit_power_law": "fit",
    "warp_to_power_law": "ground_truth",
}


def __getattr__(name: str) -> Any:
    # Imported on first use: who wants one function does not wait for SciPy's other parts.
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
