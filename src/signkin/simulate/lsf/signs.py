"""What an utterance of lsf-sim is made of: signs with their tags, and designed transitions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

RATE_HZ = 100.0
FRAME_S = 0.01


@dataclass
class Token:
    """One sign of an utterance: what, when, and between which postures."""

    gloss: str
    kind: str
    start: int = 0  # manual tags in frames
    end: int = 0
    true_s: dict[str, tuple[float, float]] = field(default_factory=dict)
    first: NDArray[np.float64] = field(default_factory=lambda: np.zeros(24))
    last: NDArray[np.float64] = field(default_factory=lambda: np.zeros(24))

    @property
    def hands(self) -> tuple[str, ...]:
        """Hands that move in the sign."""
        return ("right", "left") if self.kind.startswith("1") else ("right",)


@dataclass(frozen=True)
class Transition:
    """A designed transition: type, duration in frames, distances (rad, cm)."""

    kind: str
    frames: int
    geodesic_rad: float
    euclidean_cm: float
