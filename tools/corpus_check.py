"""What `signkin corpus check` says of the real corpora, as they are and spoilt.

    python -m tools.corpus_check DATA [--recordings N]

Spoilt: half the rate, sides swapped, each axis flipped, tags shifted by 5 s, pixels declared as
metres. The numbers stand in docs/adding-a-corpus.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from signkin.corpus import Corpus, load_corpus
from signkin.survey.look import Look, look_at

ROOT = Path(__file__).resolve().parents[1]
CORPORA = ("boston104", "dgs-1984189", "libras")
SHIFT_S = 5.0
RATES_HZ = {"boston104": 30.0, "dgs-1984189": 50.0, "libras": 120.0}


def changed(corpus: Corpus, **motion: object) -> Corpus:
    """Return the corpus with other keys of `motion`."""
    return replace(
        corpus,
        settings={**corpus.settings, "motion": {**corpus.settings["motion"], **motion}},
    )


def other_side(joint: str) -> str:
    """Return the joint of the other side."""
    side, _, part = joint.partition("_")
    return {"right": f"left_{part}", "left": f"right_{part}"}.get(side, joint)


def spoilt(corpus: Corpus) -> Iterator[tuple[str, Corpus]]:
    """Yield the corpus as it is, and each way of spoiling it that it allows."""
    motion = corpus.settings["motion"]
    yield "as it is", corpus
    half = RATES_HZ[corpus.name] / 2
    declared = half if "rate_hz" in motion else {"use": half, "instead_of_file": True}
    yield "half the rate", changed(corpus, rate_hz=declared)
    sides = {other_side(joint): source for joint, source in motion["joints"].items()}
    yield "sides swapped", changed(corpus, joints=sides)
    for key in ("up", "right"):
        axis = motion[key]
        yield f"{key} flipped", changed(corpus, **{key: axis[1:] if axis[0] == "-" else f"-{axis}"})
    if corpus.tagged:
        later = tuple(replace(e, clock_offset_s=e.clock_offset_s + SHIFT_S) for e in corpus.entries)
        yield "tags 5 s later", replace(corpus, entries=later)
    if motion.get("unit") == "px":
        yield "px as m", changed(corpus, unit="m")


def told(look: Look) -> tuple[int, int, list[str]]:
    """Return how many recordings have something wrong, how many were asked for, and what."""
    wrong = look.checks[look.checks["level"] == "wrong"]
    return len(set(wrong["recording"]) - {""}), look.asked, list(look.first[:4])


def main() -> None:
    """Print a line a corpus and change."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--recordings", type=int, default=1000)
    given = parser.parse_args()
    for name in CORPORA:
        corpus = load_corpus(ROOT / "corpora" / name)
        folder = given.data / corpus.settings.get("data_folder", name)
        for change, one in spoilt(corpus):
            wrong, asked, first = told(look_at(one, folder, given.recordings))
            print(f"{name:12s} {change:15s} wrong in {wrong:3d} of {asked}")
            for line in first:
                print(f"    {line[:150]}")


if __name__ == "__main__":
    main()
