"""The one exception that users see: which file, where in it, what, and what to do."""

from __future__ import annotations

from pathlib import Path


class SignkinError(Exception):
    """Input that cannot be used, told in one sentence and a hint.

    Parameters are the parts of the sentence: the `file`, the `place` in it
    (a line, a key, a joint), what was `found`, what was `expected`, and what
    to do about it (`todo`).
    """

    def __init__(
        self,
        found: str,
        *,
        file: str | Path | None = None,
        place: str | None = None,
        expected: str | None = None,
        todo: str | None = None,
    ) -> None:
        self.found = found
        self.file = file
        self.place = place
        self.expected = expected
        self.todo = todo
        super().__init__(str(self))

    def __str__(self) -> str:
        """Return `file, place: found; expected ... . todo`."""
        where = ", ".join(str(part) for part in (self.file, self.place) if part is not None)
        sentence = f"{where}: {self.found}" if where else self.found
        if self.expected:
            sentence = f"{sentence}; expected {self.expected}"
        if not sentence.endswith("."):
            sentence += "."
        return f"{sentence} {self.todo}" if self.todo else sentence

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by parts, so that the sentence survives a process boundary."""
        parts = {"file": self.file, "place": self.place, "expected": self.expected}
        return (_rebuild, (self.found, {**parts, "todo": self.todo}))

    def at(self, *, file: str | Path | None = None, place: str | None = None) -> SignkinError:
        """Return the same error with the file and place filled in where they were unknown."""
        return SignkinError(
            self.found,
            file=self.file if self.file is not None else file,
            place=self.place if self.place is not None else place,
            expected=self.expected,
            todo=self.todo,
        )


def _rebuild(found: str, parts: dict[str, str | None]) -> SignkinError:
    return SignkinError(found, **parts)


def listed(names: object, most: int = 12) -> str:
    """Return names as `a, b, c`, cut after `most` with the number left out."""
    items = [str(name) for name in names]  # type: ignore[attr-defined]
    if not items:
        return "none"
    head = ", ".join(items[:most])
    return head if len(items) <= most else f"{head} and {len(items) - most} more"
