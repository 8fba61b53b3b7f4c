"""`signkin audit init FILE`: claims.yaml from the text or the table of a paper, to be gone through.

From a text, or the text layer of a PDF: test statistics, confidence intervals, means with their
SDs, and tables become claims with their place. From a CSV: a table with columns of n, mean and SD.
What decides a verdict (the grain, the tails, the divisor) is asked for, never guessed.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Sequence
from pathlib import Path

from signkin.audit.claims_file import MOST_BYTES
from signkin.audit.draft_tables import from_rows, from_table
from signkin.audit.drafts import Draft, from_text
from signkin.audit.pdf import pages_of
from signkin.audit.text_tables import tables_in
from signkin.errors import SignkinError
from signkin.text_file import text_of

TABLES = (".csv", ".tsv", ".tab")


def init(arguments: Sequence[str]) -> int:
    """Write a paper's folder from a file; prints what was found and what was not understood."""
    parser = argparse.ArgumentParser(
        prog="signkin audit init",
        description=__doc__,
        epilog="example: signkin audit init paper.pdf --to mine",
    )
    parser.add_argument("file", type=Path,
                        help="the paper (.pdf, .txt) or a table (.csv, .tsv)")  # fmt: skip
    parser.add_argument("--to", type=Path, help="the folder to write; by default the file's name")
    told = parser.parse_args(list(arguments))
    if not told.file.is_file():
        raise SignkinError(f"there is no file {told.file}", expected="a text, a PDF or a table")
    draft = draft_of(told.file)
    to = told.to or Path(re.sub(r"[^A-Za-z0-9._-]+", "-", told.file.stem))
    if (to / "claims.yaml").exists():
        raise SignkinError("there is a claims.yaml already", file=to, todo="Give another --to.")
    if not draft.claims:
        for line in draft.not_understood:
            print(f"not understood: {line}")
        raise SignkinError(
            "nothing that could be checked was found", file=told.file,
            expected="statistics such as t(38) = 2.1, p = .04, or columns n, mean and sd",
        )  # fmt: skip
    to.mkdir(parents=True, exist_ok=True)
    for name, table in draft.tables.items():
        (to / name).write_text(table, encoding="utf-8")
    (to / "claims.yaml").write_text(written(draft, told.file), encoding="utf-8")
    for line in draft.not_understood:
        print(f"not understood: {line}")
    print(f"{len(draft.claims)} claims in {to / 'claims.yaml'}, {len(draft.not_understood)} places "
          f"not understood. Answer its questions, then: signkin audit {to}")  # fmt: skip
    return 0


def draft_of(file: Path) -> Draft:
    """Return what a PDF, a text or a table has."""
    with file.open("rb") as start:
        is_pdf = start.read(5) == b"%PDF-"
    if file.suffix.lower() == ".pdf" or is_pdf:
        draft = Draft()
        for number, (plain, laid_out) in enumerate(pages_of(file), 1):
            page = f"page {number}, "
            _with_tables(from_text(plain, draft, page), laid_out, file, page)
        return draft
    text = text_of(file, MOST_BYTES)
    if file.suffix.lower() in TABLES:
        return from_table(text, file)
    return _with_tables(from_text(text), text, file, "")


def _with_tables(draft: Draft, text: str, file: Path, page: str) -> Draft:
    for table in tables_in(text):
        draft.not_understood += [f"{page}{line}" for line in table.lost]
        from_rows(table.rows, file, draft, f"{page}line {table.line}")
    return draft


def written(draft: Draft, file: Path) -> str:
    """Return claims.yaml with its questions as comments."""
    head = [
        f"# Drafted from {file.name}. Go through it: every claim says where it was found, and",
        "# `# ?` starts questions whose answer a verdict may hang on.",
        f"paper: {json.dumps(file.stem)}   # ? authors and year",
        "claims:",
    ]
    tail = [f"# not understood: {line}" for line in draft.not_understood]
    return "\n".join([*head, *draft.claims, *tail]) + "\n"
