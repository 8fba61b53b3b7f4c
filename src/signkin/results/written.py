"""What jobs wrote: the hash of each output, kept beside Snakemake's own state.

Snakemake asks whether an output is there and newer than its inputs, never what is in it: a file
cut short by a full disk, or with a flipped bit, is used by the next step. Each job therefore
leaves the hashes of its outputs, and a run starts by comparing: a file that is not what its job
wrote is deleted, and said, so that no step reads it.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from signkin.checksum import sha256_of

FOLDER_MARK = ".snakemake_timestamp"  # in each folder that is an output
STATE = Path(".snakemake") / "signkin-written"


@dataclass(frozen=True)
class Difference:
    """A file that is not as its job wrote it. what: `changed`, `missing` or `not of a job`."""

    path: Path
    what: str


def record(outputs: Iterable[str | Path], state: Path = STATE) -> None:
    """Keep the hashes of a job's outputs; of a folder, those of all files in it.

    outputs: paths as the workflow has them, relative to the folder of the run.
    """
    hashes = {path.as_posix(): sha256_of(path) for path in _files(map(Path, outputs))}
    if not hashes:
        return
    state.mkdir(parents=True, exist_ok=True)
    _write(state / _name(min(hashes)), hashes)


def forget(output: str | Path, state: Path = STATE) -> None:
    """Forget a file that was recorded by itself and is no longer made."""
    (state / _name(Path(output).as_posix())).unlink(missing_ok=True)


def _write(kept: Path, hashes: dict[str, str]) -> None:
    # One file a job, replaced in one step: jobs end at the same time, and may be killed.
    unfinished = kept.with_suffix(".part")
    unfinished.write_text(json.dumps(hashes, sort_keys=True, indent=0), encoding="utf-8")
    unfinished.replace(kept)


def _name(path: str) -> str:
    return f"{hashlib.sha256(path.encode()).hexdigest()[:24]}.json"


def recorded(state: Path = STATE) -> dict[Path, str]:
    """Return path -> hash of all that jobs wrote; the later record of a path counts."""
    known: dict[Path, str] = {}
    for record_path in sorted(state.glob("*.json"), key=lambda p: (p.stat().st_mtime_ns, p.name)):
        try:
            hashes = json.loads(record_path.read_text(encoding="utf-8"))
            known |= {Path(path): str(value) for path, value in hashes.items()}
        except (ValueError, AttributeError):
            record_path.unlink()  # damaged itself: what it told is no longer known
    return known


def differences(results: Path, state: Path = STATE) -> Iterator[Difference]:
    """Yield what in a folder of results is not what its jobs wrote, by path.

    results: as the workflow names it, such as `results`. Files without a record (of a run before
    hashes were kept, or put there by hand) are `not of a job`.
    """
    known = {path: value for path, value in recorded(state).items() if path.is_relative_to(results)}
    there = set(_files([results])) if results.is_dir() else set()
    for path in sorted(known.keys() | there):
        if path not in there:
            yield Difference(path, "missing")
        elif path not in known:
            yield Difference(path, "not of a job")
        elif sha256_of(path) != known[path]:
            yield Difference(path, "changed")


def take_out_changed(state: Path = STATE, root: Path = Path()) -> list[Path]:
    """Delete files that are not what their job wrote, and return them.

    root: the folder of the run, which recorded paths are relative to. A run makes them anew where
    they are wanted: what was made of them before is of the good file. They are forgotten, as are
    files that are not there.
    """
    known = recorded(state)
    there = {path: value for path, value in known.items() if (root / path).is_file()}
    taken = [path for path, value in sorted(there.items()) if sha256_of(root / path) != value]
    for path in taken:
        (root / path).unlink(missing_ok=True)
        # Snakemake takes a folder that is there for whole, whatever it lacks.
        for folder in path.parents:
            if (root / folder / FOLDER_MARK).is_file():
                shutil.rmtree(root / folder)
    there = {path: value for path, value in there.items() if (root / path).is_file()}
    gone = {path.as_posix() for path in (known.keys() - there.keys()) | set(taken)}
    for kept in state.glob("*.json") if gone else ():
        hashes = json.loads(kept.read_text(encoding="utf-8"))
        if gone & hashes.keys():
            _write(kept, {path: value for path, value in hashes.items() if path not in gone})
    return taken


def _files(paths: Iterable[Path]) -> Iterator[Path]:
    for path in paths:
        if path.is_dir():
            yield from (
                p for p in sorted(path.rglob("*")) if p.is_file() and not p.name.startswith(".")
            )
        elif path.is_file():
            yield path
