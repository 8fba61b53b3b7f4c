"""Text files that people write: UTF-8, with or without a byte order mark."""

from __future__ import annotations

from pathlib import Path

from signkin.errors import SignkinError


def text_of(path: Path, most_bytes: int | None = None) -> str:
    """Return a text file; one that is too long or not UTF-8 is an error with its line.

    What the system says of a file that is not there is passed on.
    """
    raw = path.read_bytes()
    if most_bytes is not None and len(raw) > most_bytes:
        raise SignkinError(
            f"it has {len(raw):,} bytes", file=path, expected=f"at most {most_bytes:,}"
        )
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise SignkinError(
            f"byte {raw[error.start]:#04x} is not UTF-8", file=path, place=f"line {line}",
            expected="text in UTF-8", todo="Save the file as UTF-8.",
        ) from None  # fmt: skip
