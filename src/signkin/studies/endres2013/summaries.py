"""Summaries of the binning study of one corpus: order posteriors, hit rates, tests, chance.

Endres et al. 2013, sections 3.1 to 3.3 and A.1. Groups are all trajectories of a
dataset, and each signer's repetitions of each sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.binning.hit_rate import (
    MOST_DRAWN,
    ChanceLine,
    GroupRates,
    HitRate,
    Weights,
    bootstrap_weights,
    chance_line,
    compare_orders,
    group_rates,
    hpfpps,
)
from signkin.binning.shifted import Shifted, shifted_rates
from signkin.seeds import stream
from signkin.settings.sections import Binning
from signkin.studies.endres2013.posteriors import FITTED, FITTED_MAP
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, Trajectory

ALL = "all"
RATES_PER_S = np.concatenate([np.linspace(0, 2, 9), np.linspace(2.5, 12, 12)])
TESTED_ORDER = 3  # section 3.2: order 3 against the rest


def summaries(
    corpus: str, gathered: Mapping[str, pd.DataFrame], trajectories: Sequence[Trajectory],
    settings: Binning, seed: int,
) -> dict[str, pd.DataFrame]:  # fmt: skip
    """Return the tables order_posteriors, hit_rates, chance_lines and order_tests of a corpus.

    gathered: its tables binning and fitted_truths, of all shards.
    """
    binning = gathered["binning"]
    truths = known_boundaries(trajectories, gathered["fitted_truths"])
    rates, lines = hit_rates(corpus, binning, truths, settings, seed)
    return {
        "order_posteriors": order_posteriors(corpus, binning),
        "hit_rates": rates,
        "chance_lines": lines,
        "order_tests": order_tests(corpus, binning),
    }


def groups(
    binning: pd.DataFrame, parts: bool = True
) -> Iterator[tuple[dict[str, Any], pd.DataFrame]]:
    """Yield each group's key and rows: whole datasets, then (parts) signers and signs."""
    for (dataset, true_order), rows in binning.groupby(["dataset", "true_order"], dropna=False):
        key = {"dataset": dataset, "true_order": true_order}
        yield {**key, "signer": ALL, "sign": ALL}, rows
        if dataset in (FITTED, FITTED_MAP) or not parts:
            continue
        for (signer, sign), part in rows.groupby(["signer", "sign"]):
            yield {**key, "signer": signer, "sign": sign}, part


def order_posteriors(corpus: str, binning: pd.DataFrame, parts: bool = True) -> pd.DataFrame:
    """Return the table `order_posteriors`; parts: signers and signs apart, too."""
    rows = []
    for key, part in groups(binning, parts):
        for order, of_order in part.groupby("order"):
            p = of_order["order_probability"].to_numpy(dtype=float)
            explained = of_order["explained_variance"].to_numpy(dtype=float)
            rows.append(
                {
                    "corpus": corpus,
                    **key,
                    "order": order,
                    "mean_probability": p.mean(),
                    "se": p.std(ddof=1) / np.sqrt(len(p)) if len(p) > 1 else None,
                    "mean_count": of_order["map_count"].mean(),
                    "mean_explained_variance": explained.mean(),
                    "sd_explained_variance": explained.std(ddof=1) if len(p) > 1 else None,
                    "n": len(p),
                }
            )
    return pd.DataFrame(rows, columns=tables.TABLES["order_posteriors"].names())


def rates_by_order(part: pd.DataFrame) -> dict[int, list[HitRate]]:
    """Return the hit rates of a group's trajectories, in the same sequence for each order."""
    columns = ["order", "hits", "misses", "false_positives", "duration_s"]
    out: dict[int, list[HitRate]] = {}
    for order, hits, misses, false, duration in zip(
        *(part.sort_values(["order", "recording"])[c] for c in columns), strict=True
    ):
        rate = HitRate(int(hits), int(misses), int(false), float(duration))
        out.setdefault(int(order), []).append(rate)
    return out


Truths = Mapping[tuple[str, int | None, str], Sequence[float]]


def known_boundaries(trajectories: Sequence[Trajectory], fitted: pd.DataFrame) -> Truths:
    """Return (dataset, true order, recording) -> known boundaries in s; absent: none.

    fitted: the table `fitted_truths`.
    """
    out: dict[tuple[str, int | None, str], Sequence[float]] = {
        (POWERLAW, None, t.recording): [float(time) for time in t.boundaries_s]
        for t in trajectories
        if t.dataset == POWERLAW
    }
    for (dataset, order, recording), rows in fitted.groupby(["dataset", "true_order", "recording"]):
        out[str(dataset), int(order), str(recording)] = rows["boundary_s"].tolist()
    return out


def chance_of(
    truths: Sequence[Any], durations: Sequence[float], settings: Binning, rng: np.random.Generator
) -> ChanceLine:
    """Return the line of no discrimination of a group."""
    draws = int(np.clip(round(settings.chance_trajectories / len(durations)), 20, 400))
    return chance_line(truths, durations, rng, RATES_PER_S, settings.hit_window_s, draws)


class Drawn:
    """What was drawn at random for a group. Other readings of it draw the same: it is kept.

    Groups are told by the seed, the corpus and their names, of which the stream is made. keep:
    whether there are other readings; of a large corpus what is kept would take most of the memory.
    """

    def __init__(self, keep: bool = True) -> None:
        self._keep = keep
        self._weights: dict[tuple[Any, ...], NDArray[Any]] = {}
        self._lines: dict[tuple[Any, ...], ChanceLine] = {}

    def weights(self, group: tuple[Any, ...]) -> Weights:
        """Return what gives the bootstrap's weights of n trajectories of a group."""

        def weigh(n: int, draws: int) -> Any:
            key = (*group, n, draws)
            if key not in self._weights:
                seed, corpus, *names = group
                drawn = bootstrap_weights(stream(seed, corpus, "bootstrap", *names), n, draws)
                if not self._keep or n > MOST_DRAWN:
                    return drawn
                self._weights[key] = drawn.astype(np.min_scalar_type(n))  # an eighth of the room
            return self._weights[key].astype(np.int64)

        return weigh

    def line(
        self, group: tuple[Any, ...], truths: Sequence[Sequence[float]],
        durations: Sequence[float], settings: Binning,
    ) -> ChanceLine:  # fmt: skip
        """Return the line of no discrimination of a group."""
        told = (tuple(map(tuple, truths)), tuple(durations), settings.hit_window_s)
        key = (*group, *told, settings.chance_trajectories)
        if key not in self._lines:
            seed, corpus, *names = group
            rng = stream(seed, corpus, "chance", *names)
            self._lines[key] = chance_of(truths, durations, settings, rng)
        return self._lines[key]


def hit_rates(
    corpus: str, binning: pd.DataFrame, truths: Truths,
    settings: Binning, seed: int, parts: bool = True, drawn: Drawn | None = None,
) -> tuple[pd.DataFrame, pd.DataFrame]:  # fmt: skip
    """Return the tables `hit_rates` and `chance_lines`.

    truths: (dataset, true order, recording) -> known boundaries in s. parts: signers and signs
    apart, too. drawn: what other readings of the same groups have drawn, and this one adds.
    """
    kept = Drawn(keep=False) if drawn is None else drawn
    rate_rows, chance_rows = [], []
    for key, part in groups(binning[binning["dataset"] != RECORDED], parts):
        name = tuple(str(value) for value in key.values())
        rates = rates_by_order(part)
        recordings = sorted(part["recording"].unique())
        known = [truths.get((key["dataset"], _whole(key["true_order"]), r), []) for r in recordings]
        durations = [r.duration_s for r in next(iter(rates.values()))]
        line = None
        if any(len(times) for times in known):
            line = kept.line((seed, corpus, *name), known, durations, settings)
            chance_rows += [{"corpus": corpus, **key, **row} for row in _line_rows(line)]
        for order, of_order in rates.items():
            weights = kept.weights((seed, corpus, *name, str(order)))
            rate_rows.append(
                {
                    "corpus": corpus,
                    **key,
                    "order": order,
                    **_rate_row(of_order, line, settings, weights),
                    **_shifted_row(part[part["order"] == order]),
                }
            )
    return (
        pd.DataFrame(rate_rows, columns=tables.TABLES["hit_rates"].names()),
        pd.DataFrame(chance_rows, columns=tables.TABLES["chance_lines"].names()),
    )


def _whole(value: Any) -> int | None:
    return None if value is None or pd.isna(value) else int(value)


def _rate_row(
    rates: Sequence[HitRate], line: ChanceLine | None, settings: Binning, weights: Weights,
) -> dict[str, Any]:  # fmt: skip
    mean = group_rates(rates)
    ratio = hpfpps(rates, weights, settings.bootstrap_draws)
    finite = {
        name: value if np.isfinite(value) else None
        for name, value in (
            ("hpfpps", ratio.value), ("hpfpps_se", ratio.se), ("hpfpps_low", ratio.low),
            ("hpfpps_high", ratio.high),
        )
    }  # fmt: skip
    notes = [ratio.note]
    if not ratio.note and finite["hpfpps_high"] is None:
        notes.append("some draws have no false positive: no upper end")
    chance: dict[str, Any] = dict.fromkeys(("chance_hit_rate", "chance_low", "chance_high"))
    if line is not None:
        at = mean.false_positives_per_s
        if at <= line.false_positives_per_s[-1]:
            for column, values in (
                ("chance_hit_rate", line.hit_rate),
                ("chance_low", line.hit_rate_low),
                ("chance_high", line.hit_rate_high),
            ):
                chance[column] = float(np.interp(at, line.false_positives_per_s, values))
        else:
            notes.append("more false positives than the chance line has")
    return {
        "hit_rate": mean.hit_rate,
        "hit_rate_se": mean.hit_rate_se,
        "false_positives_per_s": mean.false_positives_per_s,
        "false_positives_per_s_se": mean.false_positives_per_s_se,
        **chance,
        **_beside(mean, chance["chance_hit_rate"]),
        **finite,
        "unbounded_draws": ratio.unbounded,
        "n": mean.n,
        "without_truth": mean.without_truth,
        "note": "; ".join(note for note in notes if note),
    }


def _beside(mean: GroupRates, by_chance: float | None) -> dict[str, float]:
    """Return what chance makes of eq. 17, and the hit rate without it."""
    if by_chance is None:
        return {}
    false = mean.false_positives_per_s
    over = {"over_chance": mean.hit_rate - by_chance}
    return over | ({"chance_hpfpps": by_chance / false} if false > 0 else {})


def _shifted_row(rows: pd.DataFrame) -> dict[str, Any]:
    """Return what the boundaries of a group's trajectories hit where they are shifted."""
    of = rows[["hits", "misses", "false_positives", "duration_s", "shifted_hits", "shifted_sd"]]
    hits, misses, false, seconds, mean, sd = of.to_numpy(dtype=float).T
    each = [Shifted(*one) for one in zip(mean, sd, strict=True)]
    found = shifted_rates(each, hits + misses, hits + false, seconds)
    used = hits + misses > 0
    rate = float(np.mean(hits[used] / (hits + misses)[used])) if used.any() else float("nan")
    row = {
        "shifted_hit_rate": found.hit_rate,
        "shifted_low": found.low,
        "shifted_high": found.high,
        "shifted_hpfpps": found.hpfpps,
        "over_shifted": rate - found.hit_rate,
    }
    return {name: value if np.isfinite(value) else None for name, value in row.items()}


def _line_rows(line: ChanceLine) -> Iterator[dict[str, float]]:
    for i, rate in enumerate(line.rate_per_s):
        yield {
            "rate_per_s": rate,
            "false_positives_per_s": line.false_positives_per_s[i],
            "hit_rate": line.hit_rate[i],
            "hit_rate_low": line.hit_rate_low[i],
            "hit_rate_high": line.hit_rate_high[i],
            "closed_form": line.closed_form[i],
        }


def order_tests(corpus: str, binning: pd.DataFrame) -> pd.DataFrame:
    """Return the table `order_tests`: order 3 against the rest, and all orders (section 3.2)."""
    part = binning[binning["dataset"] == POWERLAW]
    columns = tables.TABLES["order_tests"].names()
    rates = rates_by_order(part)
    if TESTED_ORDER not in rates or len(rates) < 2:
        return pd.DataFrame(columns=columns)
    found = compare_orders(rates, TESTED_ORDER)
    gone = sum(found.left_out.values())
    rows = []
    for test, left_out in (
        (found.one_against_rest, gone),
        (found.all_orders, gone),
        (found.friedman, found.incomplete),
    ):
        rows.append(
            {
                "corpus": corpus,
                "question": test.question,
                "test": test.test,
                "statistic": test.statistic,
                "df": test.df,
                "p": test.p,
                "n": test.n,
                "left_out": left_out,
                "without_truth": found.without_truth,
                "note": test.note,
            }
        )
    return pd.DataFrame(rows, columns=columns)
