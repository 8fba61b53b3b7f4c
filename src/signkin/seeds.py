"""Random streams: one seed in config.yaml, one stream for each name.

A stream depends on the seed and its names alone, so results do not change with
the number of cores, the order of jobs or the other recordings of a corpus.
"""

from __future__ import annotations

import hashlib

import numpy as np


def stream(seed: int, *names: str) -> np.random.Generator:
    """Return the random stream of a corpus, a recording, a purpose: `stream(1, corpus, name)`."""
    words = hashlib.sha256("\0".join(names).encode()).digest()
    key = [int.from_bytes(words[i : i + 4], "little") for i in range(0, 16, 4)]
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=tuple(key)))
