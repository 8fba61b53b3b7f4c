"""The corpus lsf-sim: simulated signing whose manual tags carry the printed Table 2.

Two recordings of a body at 100 Hz. Between the manual tags stand the 89
transitions of Naert et al. 2017: their types, numbers, means and SDs are those of
the printed Table 2, and the distances between the postures around them are
designed to lie about the printed surface with its printed mean error. Hands move
in minimum-jerk strokes, each hand with true boundaries of its own; the manual
tags stand beside them by a tagger's jitter, those of a second annotator by a lag and jitter of
their own.

It shows whether the pipeline finds what was put in. It says nothing about people.
"""

from signkin.simulate.lsf.corpus import (
    TERMS,
    SimulatedCorpus,
    SimulatedRecording,
    simulate,
    write_motion,
    write_second_tags,
    write_tags,
)
from signkin.simulate.lsf.second_tagger import second_tags
from signkin.simulate.lsf.signs import RATE_HZ

__all__ = [
    "RATE_HZ",
    "TERMS",
    "SimulatedCorpus",
    "SimulatedRecording",
    "second_tags",
    "simulate",
    "write_motion",
    "write_second_tags",
    "write_tags",
]
