"""An utterance from the command line: `signkin utterance CORPUS GLOSSES`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.stages.plan import Plan, make_plan
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import load_database
from signkin.studies.naert2017.synthesis.duration_models import printed_theta
from signkin.studies.naert2017.synthesis.utterance_files import utterance_files
from signkin.yaml_file import read_yaml

RESULTS = Path("results")
LONGEST_NAME = 60


def glosses_of(words: Sequence[str]) -> list[str]:
    """Return the glosses: one text is taken apart at commas, or else at spaces."""
    if len(words) != 1:
        return list(words)
    parts = words[0].split(",") if "," in words[0] else words[0].split()
    glosses = [part.strip() for part in parts if part.strip()]
    if not glosses:
        raise SignkinError(
            "no gloss", place="GLOSSES", expected='a list, e.g. GLOSSES="CAT3 BIRD1"'
        )
    return glosses


def name_of(glosses: Sequence[str]) -> str:
    """Return a file name made from glosses."""
    plain = "_".join(re.sub(r"[^A-Za-z0-9.-]+", "", gloss) or "x" for gloss in glosses)
    return plain[:LONGEST_NAME]


CONFIG = Path("config.yaml")


def prerequisites(
    corpus: str, changes: Mapping[str, str], root: Path, config: Path = CONFIG
) -> list[str]:
    """Return the files of the workflow that an utterance wants."""
    plan = _plan(corpus, changes, root, config)
    files = [f"results/{corpus}/recordings/{shard}.parquet" for shard in plan.shards(corpus)]
    return [*files, f"results/{corpus}/intervals.csv", f"results/{corpus}/excluded.csv"]


def speak(
    corpus: str,
    glosses: Sequence[str],
    name: str | None,
    changes: Mapping[str, str],
    root: Path,
    config: Path = CONFIG,
) -> list[str]:
    """Make and write an utterance in results/naert2017/<corpus>/synthesis; returns what to tell."""
    plan = _plan(corpus, changes, root, config)
    settings = SynthesisSettings.of(plan.settings)
    files = prerequisites(corpus, changes, root, config)
    base, _, _ = load_database(
        plan.corpora[corpus],
        files[:-2],
        files[-2],
        files[-1],
        settings,
        plan.settings.seed,
        glosses,
    )
    name = name or name_of(glosses)
    out = RESULTS / "naert2017" / corpus / "synthesis"
    parts = utterance_files(
        plan.corpora[corpus],
        plan.folders[corpus],
        base,
        {name: glosses},
        settings,
        printed_theta(plan.papers / "naert2017" / "constants.csv"),
        out,
    )
    told = []
    for row in parts.itertuples():
        source = f" {row.recording}, {row.from_s:.2f}-{row.to_s:.2f} s" if row.recording else ""
        how = f" {row.method}, {row.duration_model}" if row.kind == "transition" else ""
        note = f" ({row.note})" if row.note else ""
        told.append(
            f"{row.start_s:7.2f} {row.end_s:7.2f} s  {row.kind:10s} {row.gloss}{source}{how}{note}"
        )
    written = sorted(p for p in out.glob(f"{name}.*") if p.suffix in (".bvh", ".csv"))
    told += [f"written: {path}" for path in (*written, out / f"{name}_parts.csv")]
    return told


def _plan(corpus: str, changes: Mapping[str, str], root: Path, path: Path) -> Plan:
    """Return the plan of the folder the command is called in, for one corpus alone.

    path: of its config.yaml. A corpus that is broken does not concern another one's utterance.
    """
    if not path.is_file() and path != CONFIG:
        raise SignkinError("there is no such file", file=path, place="--config")
    config = read_yaml(path if path.is_file() else root / "config.yaml")
    config["corpora"] = [corpus]
    config["synthesis"] = {**(config.get("synthesis") or {}), **changes}
    plan = make_plan(config, root)
    if corpus not in plan.corpora:
        why = plan.missing.get(corpus)
        raise SignkinError(
            f"no corpus {corpus!r}" if why is None else f"{corpus} is not in this run: {why}",
            place="CORPUS",
            expected=listed(sorted(plan.corpora)),
        )
    return plan
