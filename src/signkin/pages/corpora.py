"""What the report says of a corpus: what it is, and how it was designed."""

from __future__ import annotations

import pandas as pd

from signkin.corpus import Corpus


def sign_columns(corpus: Corpus) -> dict[str, tuple[str, str]]:
    """Return the columns of a table of recordings that tell its signs."""
    if corpus.single_signs:
        return {"sign": ("sign", ""), "repetition": ("repetition", "d")}
    return {"signs": ("signs", "d")} if corpus.tagged else {}


def origin(corpus: Corpus) -> str:
    """Return what a corpus is, where it comes from and its licence, for a caption."""
    about = corpus.settings
    parts = [str(about["title"]) + ".", str(about.get("description", ""))]
    parts.append(f"Licence: {about['licence']}. Source: {about['citation']}.")
    return " ".join(part for part in parts if part)


def design(about: pd.DataFrame) -> str:
    """Return how many signs, signers and repetitions a table `recordings` has, as a sentence."""
    cells = about.groupby(["signer", "sign"]).size()
    signs, signers = about["sign"].nunique(), about["signer"].nunique()
    least, most = int(cells.min()), int(cells.max())
    times = f"{most} times" if least == most else f"{least} to {most} times"
    by = "one signer" if signers == 1 else f"each of {signers} signers"
    told = f"One sign a recording: {signs} signs, made {times} by {by}"
    lacking = signs * signers - len(cells)
    return told + (f"; {lacking} signs of a signer are lacking." if lacking else ".")
