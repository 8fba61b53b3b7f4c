"""The text layer of a PDF, page by page (pypdf, the extra `pdf`)."""

from __future__ import annotations

import logging
from pathlib import Path

from signkin.errors import SignkinError

MOST_BYTES, MOST_PAGES, MOST_TEXT = 60_000_000, 400, 5_000_000
OTHERWISE = "Make its text with `pdftotext -layout FILE.pdf`, and give that."


def pages_of(path: Path) -> list[tuple[str, str]]:
    """Return each page's text: in reading order, and laid out as on the page (for tables).

    A file that cannot be read, is locked, or has no text layer is an error.
    """
    try:
        import pypdf
    except ImportError:
        raise SignkinError(
            "reading a PDF wants pypdf", file=path, expected="the extra pdf: pip install "
            "'signkin[pdf]'", todo=OTHERWISE,
        ) from None  # fmt: skip
    if path.stat().st_size > MOST_BYTES:
        raise SignkinError(f"it has {path.stat().st_size:,} bytes", file=path,
                           expected=f"at most {MOST_BYTES:,}", todo=OTHERWISE)  # fmt: skip
    logging.getLogger("pypdf").setLevel(logging.ERROR)  # it tells every oddity of every font
    out: list[tuple[str, str]] = []
    try:
        reader = pypdf.PdfReader(path)
        if reader.is_encrypted and not reader.decrypt(""):
            raise SignkinError("it is locked with a password", file=path, todo=OTHERWISE)
        if len(reader.pages) > MOST_PAGES:
            raise SignkinError(f"it has {len(reader.pages)} pages", file=path,
                               expected=f"at most {MOST_PAGES}", todo=OTHERWISE)  # fmt: skip
        for page in reader.pages:
            out.append((page.extract_text(), page.extract_text(extraction_mode="layout")))
            if sum(len(plain) for plain, _ in out) > MOST_TEXT:
                raise SignkinError("it has too much text", file=path, todo=OTHERWISE)
    except SignkinError:
        raise
    except Exception as error:  # a damaged file makes pypdf raise whatever it meets
        raise SignkinError(
            f"it cannot be read as a PDF ({type(error).__name__})", file=path, todo=OTHERWISE
        ) from None
    if not any(plain.strip() for plain, _ in out):
        raise SignkinError("it has no text layer (a scan, perhaps)", file=path,
                           todo="Let a program read its pages (OCR) first.")  # fmt: skip
    return out
