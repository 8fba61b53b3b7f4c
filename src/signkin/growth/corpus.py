"""A simulated corpus of any size, written as files and read like any corpus: for tests of growth.

Signing with tags is that of lsf-sim (sixteen recordings at a time carry the printed Table 2 of
Naert et al. 2017), single signs are those of isl-sim. What is made says so in its description.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import yaml

from signkin import seeds
from signkin.corpus import Entry, load_corpus
from signkin.errors import SignkinError
from signkin.io.wide_csv import write_wide_csv
from signkin.simulate import isl, lsf

AT_ONCE = 16  # a design has up to so many utterances, each a recording of its own
SIGNERS = 8  # of tagged signing: one a design, in turn
TRIES = 20  # a design may ask for a posture that no body has
SHARD = 100  # recordings that share a job: at 0.4 s each, a job is far from a minute
EUCLIDEAN_UNIT_M = 0.1  # of the printed surface
BYTES = {"tagged": 1_400_000, "signs": 40_000}  # a recording, about


def write_corpus(
    folder: Path, kind: str, recordings: int, seed: int, home: Path,
    tell: Callable[[int], None] = lambda done: None,
) -> Path:  # fmt: skip
    """Write a corpus and a config.yaml that runs it; returns the corpus's folder.

    folder: where to; its corpus is `corpora/<kind>`, the recordings in its folder `data`. kind:
    `tagged` or `signs`. home: a checkout, for the descriptions and the printed tables. tell: called
    with the number of recordings written so far. Recordings are written as they are made, so memory
    does not grow with their number. Raises SignkinError for no recordings, and where a corpus
    stands already.
    """
    if recordings < 1:
        raise SignkinError(f"{recordings} recordings", expected="1 or more")
    _check_room(folder, kind, recordings)
    corpus = folder / "corpora" / kind
    if corpus.exists():
        raise SignkinError("there is a corpus already", file=corpus, todo="Name another folder.")
    model = home / "corpora" / ("lsf-sim" if kind == "tagged" else "isl-sim")
    data = corpus / "data"
    data.mkdir(parents=True)
    make = _tagged if kind == "tagged" else _signs
    rows = []
    for row in make(data, model, recordings, seed, home):
        rows.append(row)
        tell(len(rows))
    pd.DataFrame(rows).to_csv(corpus / "recordings.csv", index=False, lineterminator="\n")
    if (model / "signs.csv").is_file():
        shutil.copy(model / "signs.csv", corpus / "signs.csv")
    _describe(corpus, model, recordings, seed)
    _configure(folder, kind, home)
    return corpus


def _check_room(folder: Path, kind: str, recordings: int) -> None:
    """Refuse more recordings than there is room for on the disk, before hours are spent."""
    home = next(place for place in (folder, *folder.resolve().parents) if place.is_dir())
    most = shutil.disk_usage(home).free // BYTES[kind]
    if recordings > most:
        raise SignkinError(
            f"{recordings} recordings take about {recordings * BYTES[kind] / 1e9:.0f} GB",
            expected=f"at most {most}, which the disk of {home.resolve()} has room for",
            todo="Ask for fewer, or name a folder on a larger disk.",
        )


def _tagged(
    data: Path, model: Path, recordings: int, seed: int, home: Path
) -> Iterator[dict[str, Any]]:
    described = load_corpus(model)
    lexicon = described.lexicon
    text: dict[str, Any] = {"dtype": str, "keep_default_na": False}
    table2 = pd.read_csv(home / "papers/naert2017/table2.csv", **text)
    constants = pd.read_csv(home / "papers/naert2017/constants.csv", **text)
    value = constants.set_index("name")["value"]
    theta = np.array([float(value[f"theta_{term}"]) for term in lsf.TERMS])

    def corpus_of(first: int) -> lsf.SimulatedCorpus:
        count = min(AT_ONCE, recordings + 1 - first)
        names = [f"tagged-{first + i:06d}" for i in range(count)]
        for attempt in range(TRIES):
            rng = seeds.stream(seed, "tagged", f"{first}", f"{attempt}")
            try:
                return lsf.simulate(
                    names, lexicon, table2, theta, float(value["mean_error"]), EUCLIDEAN_UNIT_M,
                    rng, parts=AT_ONCE,
                )  # fmt: skip
            except SignkinError:
                if attempt == TRIES - 1:
                    raise
        raise AssertionError("not reached")

    first = design = 1
    while first <= recordings:
        for recording in corpus_of(first).recordings:
            if not recording.utterances:
                break  # a design of fewer utterances
            lsf.write_motion(recording, data / f"{recording.name}.bvh")
            lsf.write_tags(recording, data / f"{recording.name}.eaf")
            row = {
                "recording": recording.name,
                "signer": f"simulated-{design % SIGNERS + 1}",
                "motion": f"{recording.name}.bvh",
                "annotation": f"{recording.name}.eaf",
            }
            entry = Entry(
                row["recording"], row["signer"], row["motion"], row["annotation"], part="", line=0
            )
            rng = seeds.stream(seed, "tagged", "second tagger", recording.name)
            for annotator in described.annotators:
                lsf.write_second_tags(
                    recording, data / described.annotator_file(entry, annotator), rng
                )
            yield row
            first += 1
        design += 1


def _signs(
    data: Path, model: Path, recordings: int, seed: int, home: Path
) -> Iterator[dict[str, Any]]:
    noise = float(load_corpus(model).noise_sd)
    cells = [(sign, signer) for sign in isl.SIGNS for signer in isl.STYLES]
    for i in range(recordings):
        sign, signer = cells[i % len(cells)]
        name = f"signs-{i + 1:06d}"
        planned = SimpleNamespace(recording=name, signer=signer, sign=sign)
        take = isl.simulate([planned], "signs", noise, seed)[0]
        write_wide_csv(data / f"{name}.csv", isl.motion_columns(take), noise)
        yield {
            "recording": name, "signer": signer, "motion": f"{name}.csv", "sign": sign,
            "repetition": i // len(cells) + 1,
        }  # fmt: skip


def _describe(corpus: Path, model: Path, recordings: int, seed: int) -> None:
    """Write corpus.yaml: the model's, with what made it."""
    settings = yaml.safe_load((model / "corpus.yaml").read_text(encoding="utf-8"))
    settings.pop("truth_file", None)
    settings["title"] = f"Simulated: {recordings} recordings"
    settings["simulator"] = "signkin simulate"
    settings["description"] = (
        f"Made by `signkin simulate --recordings {recordings} --kind {corpus.name} --seed {seed}` "
        "to see how the workflow grows. It is no evidence about people."
    )
    text = yaml.safe_dump(settings, sort_keys=False, allow_unicode=True)
    (corpus / "corpus.yaml").write_text(text, encoding="utf-8")


def _configure(folder: Path, kind: str, home: Path) -> None:
    """Write config.yaml: the shipped one with this corpus alone, unless there is one."""
    path = folder / "config.yaml"
    if not path.exists():
        settings = yaml.safe_load((home / "config.yaml").read_text(encoding="utf-8"))
        settings["corpora"] = [kind]
        settings["recordings_per_job"] = SHARD
        settings["synthesis"]["utterances"] = []
        path.write_text(yaml.safe_dump(settings, sort_keys=False), encoding="utf-8")
