"""What steps of a corpus cost on many recordings: `python -m tools.growth_tables RUN TIMES ...`.

RUN: a finished run of `signkin simulate --kind tagged` (a folder of `tools.growth`). Its tables are
repeated so many times over, recordings under other names, and the steps that read the tables of a
whole corpus run on them: sizes for which simulating and reading motion would take hours. Printed:
CPU in s and the most memory so far in MB, a line a step.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from signkin import tables
from signkin.corpus import load_corpus
from signkin.figures.style import paper_style, save
from signkin.settings import load_settings
from signkin.studies.naert2017 import durations_models, durations_surface
from signkin.studies.naert2017.durations_statistics import statistics
from signkin.studies.naert2017.figures.refinement_quality import draw_quality
from signkin.studies.naert2017.posterior_durations import posterior_durations
from signkin.studies.naert2017.posteriors import tag_models
from signkin.studies.naert2017.refinement import refinement
from signkin.studies.naert2017.sampling import sample
from signkin.studies.naert2017.settings import DurationSettings
from signkin.studies.naert2017.table2 import table2
from signkin.studies.naert2017.tag_chance import tag_chance
from signkin.yaml_file import read_yaml

CORPUS = "tagged"
ROOT = Path(__file__).parents[1]
PLACES = {
    "recordings": f"{CORPUS}/recordings.csv",
    "intervals": f"{CORPUS}/intervals.csv",
    "minima": f"{CORPUS}/minima.csv",
    "boundaries": f"naert2017/{CORPUS}/boundaries.csv",
    "boundary_posteriors": f"naert2017/{CORPUS}/boundary_posteriors.csv",
    "sign_types": f"naert2017/{CORPUS}/sign_types.csv",
    "transitions": f"naert2017/{CORPUS}/transitions.csv",
    "transition_speeds": f"naert2017/{CORPUS}/transition_speeds.csv",
}


def repeated(frame: pd.DataFrame, times: int) -> pd.DataFrame:
    """Return a table so many times over, each time of other recordings."""
    parts = [frame.assign(recording=frame["recording"] + f"-{i:05d}") for i in range(times)]
    return pd.concat(parts, ignore_index=True)


def corpus_of(run: Path, times: int, to: Path) -> Any:
    """Write the corpus's folder with its recordings repeated, and load it."""
    own = to / CORPUS
    own.mkdir()
    for name in ("corpus.yaml", "signs.csv"):
        (own / name).write_bytes((run / "corpora" / CORPUS / name).read_bytes())
    listed = pd.read_csv(run / "corpora" / CORPUS / "recordings.csv", dtype=str)
    every = repeated(listed, times)
    for column, suffix in (("motion", ".bvh"), ("annotation", ".eaf")):
        every[column] = every["recording"] + suffix
    every.to_csv(own / "recordings.csv", index=False)
    return load_corpus(own)


def timed(name: str, step: Callable[[], Any]) -> Any:
    """Run a step and print what it cost."""
    start = time.process_time()
    out = step()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(f"| {name} | {time.process_time() - start:.1f} | {peak:.0f} |", flush=True)
    return out


def steps(run: Path, times: int) -> None:
    """Run the steps on the tables of a run, so many times over."""
    settings = load_settings(read_yaml(run / "config.yaml"))
    seed, unit = settings.seed, "m"
    with tempfile.TemporaryDirectory() as folder:
        corpus = corpus_of(run, times, Path(folder))
        for name, place in PLACES.items():
            whole = repeated(tables.read_table(run / "results" / place, name), times)
            tables.write_table(whole, Path(folder) / f"{name}.csv", name, unit)
        os.chdir(folder)
        of = timed("read tables", lambda: {n: tables.read_table(f"{n}.csv", n) for n in PLACES})
        print(
            f"{len(of['recordings']):,} recordings, {len(of['transitions']):,} rows of transitions"
        )
        chosen = sample(
            CORPUS,
            of["boundaries"]["recording"],
            of["intervals"],
            settings.samples.transitions,
            seed,
        )
        near = (corpus, of["recordings"], of["intervals"], of["minima"])
        _, chance = timed(
            "quality of the refinement",
            lambda: refinement(*near, of["boundaries"], settings.refinement, seed, chosen),
        )
        timed("tags against nulls", lambda: tag_chance(*near, chosen, settings.refinement, seed))
        timed(
            "jitter of tags",
            lambda: tag_models(corpus, chosen.names, *near[2:], of["sign_types"], 6.0),
        )
        moves, own = of["transitions"], chosen.rows(of["transitions"])
        posteriors = chosen.rows(of["boundary_posteriors"])
        timed(
            "posterior durations",
            lambda: posterior_durations(CORPUS, own, posteriors, unit, 0.1, seed),
        )
        printed = pd.read_csv(
            ROOT / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False
        )
        timed("Table 2", lambda: table2(CORPUS, moves, printed, settings.transitions))
        with paper_style():
            drawn = (Path("q.svg"), Path("q.pdf"))
            timed(
                "figure of the refinement",
                lambda: save(draw_quality(of["boundaries"], chance, 0.15), *drawn),
            )
        timed("write tables", lambda: [
            tables.write_table(of[n], f"{n}.csv", n, unit)
            for n in ("boundaries", "boundary_posteriors", "sign_types", "transitions")
        ])  # fmt: skip
        durations = DurationSettings.of(settings)
        timed("tests of durations", lambda: statistics(CORPUS, moves, unit, durations, seed))
        numbers = pd.read_csv(
            ROOT / "papers/naert2017/constants.csv", dtype=str, keep_default_na=False
        )
        constants = dict(zip(numbers["name"], numbers["value"], strict=True))
        learn = durations_models.learnable(moves, of["transition_speeds"], unit, durations)
        timed(
            "models of duration",
            lambda: durations_models.models(CORPUS, learn, durations, constants, seed),
        )
        timed(
            "their coefficients",
            lambda: durations_surface.coefficients(CORPUS, learn, durations, constants, seed),
        )
        os.chdir(ROOT)


def main() -> None:
    """Run every size in a process of its own, so that memory is that of the size."""
    run, *times = sys.argv[1:]
    if len(times) == 1:
        steps(Path(run).resolve(), int(times[0]))
        return
    for size in times:
        subprocess.run([sys.executable, "-m", "tools.growth_tables", run, size], check=True)


if __name__ == "__main__":
    main()
