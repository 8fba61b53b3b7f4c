"""Views that can be made of a corpus's tables, and a line for those that cannot."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable

import pandas as pd

from signkin.errors import SignkinError
from signkin.report.page import TableView, View

ABSENT = "Not available: the report's table of what could not be made tells why."
# What a table without rows makes of code that takes a first row, a maximum, a share.
CANNOT = (ValueError, LookupError, ZeroDivisionError, TypeError, AttributeError, SignkinError)


def attempted(title: str, make: Callable[[], View | Iterable[View]]) -> list[View]:
    """Return the views that `make` gives; where it fails, a last one that says so under the title.

    A table without rows, of an analysis that could not run, has no first row, no maximum and no
    share to tell: what is said of it cannot be made, and does not stop the page.
    """
    out: list[View] = []
    try:
        made = make()
        if isinstance(made, View):
            return [made]
        for view in made:
            out.append(view)
    except CANNOT as error:
        if not isinstance(error, SignkinError):
            traceback.print_exc()  # into the job's log: it may be our own mistake
        out.append(TableView("", title, ABSENT, pd.DataFrame(), {}))
    return out
