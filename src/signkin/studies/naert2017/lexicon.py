"""Which glosses signs.csv and the annotation of a corpus have in common."""

from __future__ import annotations

import pandas as pd

from signkin import tables
from signkin.corpus import Corpus

UNUSED = "occurs in no recording: misspelt?"

UNTYPED = "not in signs.csv: typed from motion"


def lexicon_use(corpus: Corpus, sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return the table `lexicon`: which glosses signs.csv and the annotation have in common."""
    counts = sign_types["gloss"].value_counts()
    glosses = sorted(set(counts.index) | set(corpus.lexicon))
    rows = []
    for gloss in glosses:
        occurrences, digits = int(counts.get(gloss, 0)), corpus.lexicon.get(gloss, "")
        note = UNUSED if not occurrences else "" if digits else UNTYPED
        rows.append((corpus.name, gloss, digits, occurrences, note))
    return pd.DataFrame(rows, columns=tables.TABLES["lexicon"].names())
