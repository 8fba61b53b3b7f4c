"""Files that a library reads: what it makes of a damaged one is one sentence."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from signkin.errors import SignkinError

LONGEST = 200  # of a library's own words


@contextmanager
def damage_told(what: str, content: bytes, expected: str) -> Iterator[None]:
    """Turn what a library raises inside the block into a SignkinError; its warnings are not shown.

    what: a kind of file, with its article. content: the whole file. expected: of the file.
    Libraries let struct, index, key, zip and assertion errors through, each its own.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except SignkinError:
        raise
    except Exception as error:
        raise SignkinError(
            f"not readable as {what} ({type(error).__name__}: {str(error)[:LONGEST]})",
            place=f"{len(content)} bytes",
            expected=expected,
        ) from error
