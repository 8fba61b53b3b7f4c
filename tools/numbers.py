"""Write the numbers of docs/interpretations.md into their marked places.

python -m tools.numbers RESULTS DATA [naert2017] [powerlaw] [binning] [readings] [order_map]

RESULTS: the results folder of a finished run. DATA: the folder of the real recordings. Prints every
table, also those that the page only quotes, and fills the places that a program has on the page;
each takes some five minutes on one core. Below a place's table stands what it was made from:
digests of the settings, of the corpora's descriptions (which hold their files' checksums), and of
the code.
"""

from __future__ import annotations

import datetime
import hashlib
import importlib
import json
import re
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from signkin.provenance import code_digest
from tools import marked
from tools.shipped import shipped

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "interpretations.md"


@dataclass(frozen=True)
class Program:
    """A module of tools: the sections of config.yaml and the corpora its places are made from."""

    sections: tuple[str, ...]
    corpora: tuple[str, ...]


PROGRAMS = {
    "naert2017": Program(
        ("seed", "kinematics", "refinement", "transitions"), ("lsf-sim", "dgs-1984189")
    ),
    "powerlaw": Program(
        ("powerlaw",), ("isl-sim", "dgs-1984189", "libras", "isl-kinect", "auslan-hq")
    ),
    "binning": Program(
        ("seed", "powerlaw", "binning"),
        ("isl-sim", "isl-kinect", "auslan-hq", "lsf-sim", "dgs-1984189", "libras"),
    ),
    "readings": Program(("seed", "powerlaw", "binning"), ("isl-sim", "isl-kinect", "auslan-hq")),
    "order_map": Program(("seed", "powerlaw", "binning"), ("isl-sim",)),
}
# Keys that came later, and that leave everything as it was where they are null.
ADDED = ("binning.prior.length_unit",)


def _digest(parts: Iterable[bytes]) -> str:
    return hashlib.sha256(b"\0".join(parts)).hexdigest()[:12]


def _described(folder: Path) -> list[bytes]:
    """Return what a corpus's folder says of its recordings and how they are read."""
    about = yaml.safe_load((folder / "corpus.yaml").read_text(encoding="utf-8"))
    kept = {key: about.get(key) for key in ("motion", "annotation", "noise_sd", "checksums")}
    tables = (folder / name for name in ("recordings.csv", "signs.csv"))
    return [
        json.dumps(kept, sort_keys=True).encode(),
        *(table.read_bytes() for table in tables if table.is_file()),
    ]


def _without_added(settings: dict[str, Any]) -> dict[str, Any]:
    """Return settings without the keys that came later and are null: numbers do not know them."""
    for path in ADDED:
        *above, last = path.split(".")
        place = settings
        for name in above:
            place = place.get(name, {})
        if last in place and place[last] is None:
            del place[last]
    return settings


def inputs(program: str) -> dict[str, str]:
    """Return digests of what the numbers of a program depend on, as they are now."""
    of = PROGRAMS[program]
    chosen = _without_added(shipped().model_dump(include=set(of.sections)))
    corpora = [_described(ROOT / "corpora" / corpus) for corpus in of.corpora]
    return {
        "settings": _digest([json.dumps(chosen, sort_keys=True).encode()]),
        "corpora": _digest(part for corpus in corpora for part in corpus),
        "code": code_digest(ROOT / "tools" / f"{program}.py")[:12],
    }


def command(program: str) -> str:
    """Return what writes the numbers of a program anew."""
    return f"python -m tools.numbers RESULTS DATA {program}"


def note(program: str, day: str) -> str:
    """Return the line below a table."""
    made = ", ".join(f"{key} {digest}" for key, digest in inputs(program).items())
    return f"*`{command(program)}`, {day}: {made}.*"


NOTE = re.compile(r"^\*`python -m tools\.numbers RESULTS DATA (\w+)`, (\d{4}-\d\d-\d\d): (.*)\.\*$")


def recorded(content: str) -> tuple[str, dict[str, str]]:
    """Return the program of a place and the digests that its numbers were made from."""
    found = NOTE.match(content.rstrip("\n").rsplit("\n", 1)[-1])
    if found is None:
        raise marked.MarkError("a place without the line that tells what it was made from")
    return found[1], dict(part.split(" ") for part in found[3].split(", "))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a Markdown table."""
    lines = ["| " + " | ".join(row) + " |" for row in (head, *rows)]
    lines.insert(1, "|---" * (lines[0].count(" | ") + 1) + "|")
    return "\n".join(lines)


def main(results: Path, data: Path, programs: Iterable[str]) -> None:
    """Run programs and fill their places."""
    day = datetime.datetime.now(datetime.UTC).date().isoformat()
    for name in programs:
        module = importlib.import_module(f"tools.{name}")
        below = note(name, day)  # before it works: the files may change meanwhile
        places: Mapping[str, str] = module.main(results, data)
        marked.fill(PAGE, {place: f"{text}\n\n{below}" for place, text in places.items()})
        print(f"\n{PAGE.relative_to(ROOT)}: {', '.join(places)}", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 3 or not all(Path(folder).is_dir() for folder in sys.argv[1:3]):
        sys.exit(f"{command('[PROGRAM ...]')}: two folders, of a run and of the recordings")
    chosen = sys.argv[3:] or list(PROGRAMS)
    if unknown := sorted(set(chosen) - set(PROGRAMS)):
        sys.exit(f"no program {', '.join(unknown)}; expected {', '.join(PROGRAMS)}")
    main(Path(sys.argv[1]), Path(sys.argv[2]), chosen)
