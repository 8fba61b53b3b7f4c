"""What the recordings themselves say of the prior that 3.2 does not print (empirical Bayes).

Degrees of freedom, noise and concentration are learnt on one half of the recordings, and the
other half is predicted, then the other way round; beside it the prior of config.yaml, the one
beside it, and the data's variances as they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.binning import Prior, held_out, learn_prior, log_evidences
from signkin.binning.all_counts import log_sum
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.settings.sections import Prior as PriorSettings
from signkin.studies.endres2013.posteriors import chosen, prior_id, prior_of
from signkin.studies.endres2013.settings import ChoiceSettings
from signkin.studies.endres2013.single_signs import RECORDED, Trajectory

Floats = NDArray[np.float64]
LEARNT = "learnt"
HALVES = ("first", "second")


@dataclass(frozen=True, eq=False)
class _Half:
    """Trajectories, centred, with the durations of their bins."""

    x: list[Floats]
    dt_s: list[float]

    @property
    def numbers(self) -> int:
        return sum(one.size for one in self.x)


def learnt_priors(
    corpus: Corpus, trajectories: Sequence[Trajectory], settings: ChoiceSettings, workers: int
) -> pd.DataFrame:
    """Return the table `learnt_prior`: a row a prior and a half of the recordings that is held out.

    trajectories: of all shards; of the recorded ones at most `learnt_recordings`.
    """
    columns = tables.TABLES["learnt_prior"].names(corpus.unit)
    usable, left_out = _usable(corpus, trajectories, settings)
    if len(usable) < 4:
        return pd.DataFrame(columns=columns)
    halves = [
        _Half([t.x - t.x.mean(axis=0) for t in part], [t.bin_s for t in part])
        for part in (usable[::2], usable[1::2])
    ]
    note = f"{left_out} of other dimensions or too few bins left out" if left_out else ""
    rows = []
    for held, train, name in ((0, 1, HALVES[0]), (1, 0, HALVES[1])):
        own = {"corpus": corpus.name, "held_out": name}
        pair = (halves[train], halves[held])
        rows += [{**own, **row} for row in _rows(corpus, *pair, settings, workers, note)]
    return pd.DataFrame(rows, columns=columns)


def _usable(
    corpus: Corpus, trajectories: Sequence[Trajectory], settings: ChoiceSettings
) -> tuple[list[Trajectory], int]:
    """Return recorded trajectories with the commonest number of dimensions; how many are not."""
    recorded = {t.recording: t for t in trajectories if t.dataset == RECORDED}
    names = [e.recording for e in corpus.entries if e.recording in recorded]
    picked = [recorded[name] for name in chosen(names, settings.choices.learnt_recordings)]
    sizes = [t.x.shape[1] for t in picked]
    common = max(set(sizes), key=sizes.count) if sizes else 0
    orders = settings.choices.orders
    fine = [
        t for t in picked
        if t.x.shape[1] == common and len(t.x) > max(orders) and np.isfinite(t.x).all()
        and (t.x.std(axis=0) > 0).all()
    ]  # fmt: skip
    return fine, len(picked) - len(fine)


def _rows(
    corpus: Corpus, train: _Half, held: _Half, settings: ChoiceSettings, workers: int, note: str
) -> Iterator[dict[str, Any]]:
    orders, dims = settings.choices.orders, train.x[0].shape[1]
    fixed: dict[str, PriorSettings] = {}
    for one in (settings.fit.prior, settings.choices.beside, _data(settings.fit.prior)):
        fixed.setdefault(prior_id(one), one)

    def outcome(priors: Sequence[Sequence[Prior]]) -> tuple[dict[str, Any], Floats]:
        own, other = (
            log_evidences(half.x, orders, each, half.dt_s, workers=workers)
            for half, each in zip((train, held), priors, strict=True)
        )
        total = own.sum(axis=0)
        share = np.exp(total - log_sum(total))
        predicted = held_out(own, other)
        return {
            "order": orders[int(np.argmax(share))],
            "order_probability": float(share.max()),
            "log_density_train": (log_sum(total) - np.log(len(orders))) / train.numbers,
            "log_density_held_out": float(predicted.sum()) / held.numbers,
            "n_train": len(train.x),
            "n_held_out": len(held.x),
        }, predicted

    reference: Floats | None = None
    for name, one in fixed.items():
        priors = [
            [prior_of(one, corpus.noise_sd, x, corpus.unit) for x in half.x]
            for half in (train, held)
        ]
        row, predicted = outcome(priors)
        reference = predicted if reference is None else reference
        told = "its noise is from each trajectory itself" if one.noise == "data" else ""
        yield {
            "prior": name, **_values(priors[0], dims, corpus.unit), **row,
            **_gain(predicted, reference), "note": "; ".join(n for n in (told, note) if n),
        }  # fmt: skip
    start = prior_of(settings.fit.prior, corpus.noise_sd, train.x[0], corpus.unit)
    try:
        found = learn_prior(train.x, orders, start, train.dt_s, workers=workers)
    except SignkinError as error:
        yield {"prior": LEARNT, "note": "; ".join(n for n in (str(error), note) if n)}
        return
    row, predicted = outcome([[found.prior] * len(half.x) for half in (train, held)])
    assert reference is not None
    yield {
        "prior": LEARNT, **_values([found.prior], dims, corpus.unit), **row,
        **_gain(predicted, reference), "evaluations": found.evaluations,
        "note": "; ".join(n for n in (found.note, note) if n),
    }  # fmt: skip


def _data(prior: PriorSettings) -> PriorSettings:
    """Return the data's variances as expected noise, the rest as configured."""
    told = {"noise": "data", "scale": "expected", "length_unit": None}
    return prior.model_copy(update=told)


def _values(priors: Sequence[Prior], dims: int, unit: str) -> dict[str, Any]:
    """Return degrees of freedom, noise and concentration; medians where trajectories differ."""
    of_each = [np.exp(np.log(one.expected_noise(dims)).mean()) for one in priors]
    return {
        "dof": priors[0].degrees(dims),
        f"noise_sd_{unit}": float(np.median(of_each)),
        "concentration": priors[0].concentration,
    }


def _gain(predicted: Floats, reference: Floats) -> Mapping[str, float | None]:
    """Return the gain over the prior of config.yaml, in nats a trajectory, and its SE."""
    gain = predicted - reference
    se = float(gain.std(ddof=1) / np.sqrt(len(gain))) if len(gain) > 1 else None
    return {"gain": float(gain.mean()), "gain_se": se}
