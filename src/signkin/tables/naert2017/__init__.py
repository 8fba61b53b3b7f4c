"""Tables of Naert, Larboulette & Gibet 2017, a file a subject."""

from signkin.tables.naert2017 import (
    durations,
    figures,
    open_choices,
    printed,
    refinement,
    synthesis,
    transitions,
)

TABLES = (
    *refinement.TABLES,
    *transitions.TABLES,
    *printed.TABLES,
    *figures.TABLES,
    *durations.TABLES,
    *synthesis.TABLES,
    *open_choices.TABLES,
)
