"""Text of files: decoded strictly, numbers taken strictly, quoted in brief.

What a file does not say in UTF-8 (or with a byte order mark, in UTF-16 or UTF-32) is an error with
its line, or has a declared encoding. Lines end at LF, CR LF or CR and nowhere else, so that a line
number is the one an editor shows.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from pathlib import Path

from signkin.errors import SignkinError

# A larger text is no recording that fits a computer of today: it is refused, not tried.
LARGEST_BYTES = 1 << 30
LONGEST_QUOTE = 60
LONGEST_PART = 600
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_LINE_END = re.compile(rb"\r\n|\n|\r")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
NOT_A_NUMBER = frozenset({"nan", "-nan", "+nan", "-nan(ind)", "nan(ind)", "1.#qnan", "-1.#ind"})


def quoted(text: object) -> str:
    """Return a text for an error message: in quotes, on one line, cut after 60 characters."""
    whole = str(text)
    return repr(whole) if len(whole) <= LONGEST_QUOTE else f"{whole[: LONGEST_QUOTE - 3]!r}..."


def brief(error: SignkinError) -> SignkinError:
    """Return an error whose parts are one line each and at most 600 characters."""

    def cut(part: str | None) -> str | None:
        if part is None:
            return None
        line = "".join(c if c.isprintable() else " " for c in part)
        return line if len(line) <= LONGEST_PART else f"{line[: LONGEST_PART - 3]}..."

    return SignkinError(
        cut(error.found) or "",
        file=error.file,
        place=cut(error.place),
        expected=cut(error.expected),
        todo=cut(error.todo),
    )


def content_of(path: Path) -> bytes:
    """Return the bytes of a file of a size that can be read at once."""
    try:
        size = path.stat().st_size
        if size > LARGEST_BYTES:
            raise SignkinError(
                f"{size / 1e6:.0f} MB in one file",
                expected=f"{LARGEST_BYTES / 1e6:.0f} MB or less",
                todo="Keep the joints and the excerpt that you need.",
            )
        return path.read_bytes()
    except OSError as error:
        raise SignkinError(f"not readable ({error.strerror})", file=path) from error


def encoding_of(content: bytes, declared: str | None = None) -> str:
    """Return the encoding of a text: that of its byte order mark, the declared one, or UTF-8."""
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    if declared is None:
        return "utf-8"
    try:
        return codecs.lookup(declared).name
    except (LookupError, TypeError) as error:
        raise SignkinError(
            f"the encoding is {quoted(declared)}",
            place="options, encoding",
            expected="the name of an encoding, such as latin-1 or utf-16",
        ) from error


def text_lines(path: Path, encoding: str | None = None) -> Iterator[str]:
    """Yield the lines of a text file, without their ends; the first is line 1.

    A byte that does not belong to the encoding is an error with its line, and so is a zero byte,
    which no text has.
    """
    content = content_of(path)
    name = encoding_of(content, encoding)
    if name in ("utf-16", "utf-32") or name.startswith(("utf-16", "utf-32")):
        content = _decoded(content, name, 0).encode()
        name = "utf-8"
    start = len(codecs.BOM_UTF8) if content.startswith(codecs.BOM_UTF8) else 0
    line = 1
    for end in _LINE_END.finditer(content):
        yield _decoded(content[start : end.start()], name, line)
        start, line = end.end(), line + 1
    if start < len(content):
        yield _decoded(content[start:], name, line)


def _decoded(content: bytes, encoding: str, line: int) -> str:
    where = f"line {line}" if line else None
    try:
        text = content.decode(encoding)
    except UnicodeError as error:
        found = getattr(error, "object", b"")[getattr(error, "start", 0) :][:1]
        raise SignkinError(
            f"byte 0x{found.hex()} is not {encoding.upper().removesuffix('-SIG')}",
            place=where,
            expected="text in UTF-8",
            todo="Declare what the file is written in, e.g. options: {encoding: latin-1}.",
        ) from error
    if "\0" in text:
        raise SignkinError(
            "zero bytes, which no text has",
            place=where,
            expected="a text file",
            todo="Is it UTF-16 without a byte order mark? Declare options: {encoding: utf-16-le}.",
        )
    return text


def number(word: str) -> float | None:
    """Return a finite number as written in decimal digits, or None: no inf, no 1_000, no 0x10."""
    if _NUMBER.fullmatch(word) is None:
        return None
    value = float(word)
    return value if abs(value) < float("inf") else None


def half_digit(word: str) -> float:
    """Return half a unit of the last printed digit: 0.0083 stands for 0.00825 to 0.00835."""
    mantissa, _, exponent = word.strip().lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    try:
        return float(0.5 * 10.0 ** (int(exponent or 0) - decimals))
    except (ValueError, OverflowError):
        return 0.0
