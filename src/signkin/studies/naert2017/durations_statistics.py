"""Do transition durations differ by type, and with distance? (Naert et al. 2017, section 5.1)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.settings.sections import Durations
from signkin.statistics import anova, association, equivalence, mixed, posthoc, power
from signkin.statistics.descriptive import hand_change, outliers
from signkin.statistics.findings import Finding, Kind, grouped, table, untestable
from signkin.statistics.multiplicity import holm
from signkin.studies.naert2017.distances import with_flags
from signkin.studies.naert2017.durations_words import Question, in_words, isochrony_in_words
from signkin.studies.naert2017.settings import DurationSettings
from signkin.studies.naert2017.transitions import counted

NO_TYPE = "no sign has a type"
TWO_HANDED = "1"  # first digit of a type: symmetry is defined for these signs alone
TYPE = Question(
    "type", "type",
    "the types' true means scatter with an SD below {half} s, though one type may lie farther off",
    together=True,
)  # fmt: skip
CHANGE = Question(
    "change of hands", "change of hands", "all means lie within ± {bound} s of each other",
    together=True,
)  # fmt: skip
HANDS, SYMMETRY = (
    Question(
        name, f"{name} before x {name} after",
        "the means differ by less than ± {bound} s, before and after", together=False,
    )
    for name in ("hands", "symmetry")
)  # fmt: skip
# The test that decides: Welch's, which wants no equal variances; type II for two factors.
DECIDES = {(anova.WELCH, anova.ETA), (anova.TYPE_2, anova.PARTIAL_ETA)}


def statistics(
    corpus: str, transitions: pd.DataFrame, unit: str, settings: DurationSettings, seed: int
) -> pd.DataFrame:
    """Return the table `statistics`."""
    rows = counted(transitions)
    typed = rows[rows["type"] != ""]
    chosen = settings.durations
    parts = []
    for label, kept in _with_and_without_outliers(typed, settings.transitions.outlier_iqr):
        inferred = int((kept["type_source"] == "kinematic").sum())
        for question, findings in _corrected(_type_questions(kept, chosen)).items():
            told = [*findings, in_words(question, findings, len(kept), inferred, chosen)]
            parts.append(_rows(corpus, question.name, label, told))
    rng = seeds.stream(seed, corpus, "correlations")
    parts.append(_rows(corpus, "distance", "kept", _distances(transitions, unit, settings, rng)))
    return pd.concat(parts, ignore_index=True)[tables.TABLES["statistics"].names()]


def _rows(corpus: str, question: str, label: str, findings: Iterable[Finding]) -> pd.DataFrame:
    frame = table(findings)
    for place, (column, value) in enumerate(
        {"corpus": corpus, "question": question, "outliers": label}.items()
    ):
        frame.insert(place, column, value)
    return frame


def _with_and_without_outliers(
    rows: pd.DataFrame, fences_iqr: float
) -> Iterator[tuple[str, pd.DataFrame]]:
    flags = outliers(rows["duration_s"].to_numpy(dtype=float), fences_iqr)
    yield ("kept" if flags.any() else "none"), rows
    if flags.any():
        yield "left out", rows[~flags]


# --- types -----------------------------------------------------------------------------------


def _type_questions(rows: pd.DataFrame, chosen: Durations) -> dict[Question, list[Finding]]:
    """Return the findings of each question about types."""
    if not len(rows):
        return {
            q: [untestable(anova.CLASSIC, Kind.DIFFERENCE, q.name, 0, NO_TYPE)]
            for q in (TYPE, CHANGE)
        }
    durations = rows["duration_s"].to_numpy(dtype=float)
    alpha, bound = chosen.alpha, chosen.equivalence_s
    digits = [rows["type"].str[i].to_numpy(dtype=object) for i in range(4)]
    changes = rows["type"].map(hand_change)
    found = {
        TYPE: _groups(TYPE.name, durations, rows, rows["type"], chosen),
        CHANGE: [
            *_groups(CHANGE.name, durations, rows, changes, chosen),
            *_smallest_differences(grouped(durations, changes), CHANGE.name, chosen),
            *equivalence.tost_pairs(grouped(durations, changes), CHANGE.name, bound, alpha),
        ],
        # As in Fig. 10, type 2 is two-handed.
        HANDS: _factors(HANDS.name, durations, digits[0], digits[2], ("one", "two"), chosen),
        SYMMETRY: _symmetry(durations, digits, chosen),
    }
    return {q: [_decided(f) for f in findings] for q, findings in found.items()}


def _corrected(found: Mapping[Question, list[Finding]]) -> dict[Question, list[Finding]]:
    """Correct the deciding tests for their number: all ask whether the types of signs matter."""
    every = holm([f for findings in found.values() for f in findings], lambda f: f.decisive)
    ends = np.cumsum([len(findings) for findings in found.values()]).tolist()
    starts = [0, *ends[:-1]]
    return {q: every[a:b] for q, a, b in zip(found, starts, ends, strict=True)}


def _decided(f: Finding) -> Finding:
    return replace(f, decisive=(f.test, f.effect_name) in DECIDES and bool(np.isfinite(f.p)))


def _groups(
    name: str,
    durations: np.ndarray,
    rows: pd.DataFrame,
    labels: pd.Series,
    chosen: Durations,
) -> list[Finding]:
    groups = grouped(durations, labels)
    alpha = chosen.alpha
    data = rows[["duration_s", "signer", "recording"]].assign(group=labels)
    return [
        *anova.one_way(groups, name, alpha, chosen.effect_f),
        *mixed.mixed_model(data, name),
        *posthoc.pairwise(groups, name, alpha),
        *power.sensitivity(groups, name, alpha, chosen.power),
        equivalence.omnibus(groups, name, chosen.equivalence_s, alpha),
    ]


def _smallest_differences(
    groups: Mapping[str, np.ndarray], name: str, chosen: Durations
) -> list[Finding]:
    labels = list(groups)
    return [
        power.sensitivity_of_two(
            groups[a], groups[b], f"{name}: {a} - {b}", chosen.alpha, chosen.power, (a, b)
        )
        for i, a in enumerate(labels)
        for b in labels[i + 1 :]
    ]


def _factors(
    name: str,
    durations: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    labels: tuple[str, str],
    chosen: Durations,
) -> list[Finding]:
    alpha = chosen.alpha
    out = anova.factorial(
        durations, before, after, (f"{name} before", f"{name} after"), alpha, chosen.effect_f
    )
    for side, digit in (("before", before), ("after", after)):
        out += _two_groups(f"{name} {side}", durations, digit, labels, chosen)
    return out


def _two_groups(
    title: str,
    durations: np.ndarray,
    digits: np.ndarray,
    labels: tuple[str, str],
    chosen: Durations,
) -> list[Finding]:
    """Compare two groups, by whether a digit is 0 (the first label)."""
    groups = grouped(durations, np.where(digits == "0", *labels))
    return [
        *_smallest_differences(groups, title, chosen),
        *equivalence.tost_pairs(groups, title, chosen.equivalence_s, chosen.alpha),
    ]


def _symmetry(durations: np.ndarray, digits: list[np.ndarray], chosen: Durations) -> list[Finding]:
    """Return the findings about symmetry, which only two-handed signs have (5.1).

    Both signs have to be two-handed to be crossed; for one side, the sign on that side.
    """
    two = [digits[i] == TWO_HANDED for i in (0, 2)]
    both = two[0] & two[1]
    names = (f"{SYMMETRY.name} before", f"{SYMMETRY.name} after")
    crossed = anova.factorial(
        durations[both], digits[1][both], digits[3][both], names, chosen.alpha,
        chosen.effect_f,
    )  # fmt: skip
    out = [f.noted(_not_two_handed(both, "a sign that is not two-handed")) for f in crossed]
    for name, held, digit, side in zip(
        names, two, (digits[1], digits[3]), ("before", "after"), strict=True
    ):
        found = _two_groups(name, durations[held], digit[held], ("asymmetric", "symmetric"), chosen)
        out += [f.noted(_not_two_handed(held, f"the sign {side} is not two-handed")) for f in found]
    return out


def _not_two_handed(held: np.ndarray, why: str) -> str:
    left = int((~held).sum())
    return f"{left} transitions left out: {why}" if left else ""


# --- distance --------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Plan:
    """One distance that durations are set against."""

    hand: str
    segmentation: str
    column: str

    @property
    def title(self) -> str:
        body = "whole body" if self.hand == "both" else f"{self.hand} arm"
        return f"duration and {self.column}, {body}, {self.segmentation} tags"

    def rows(self, transitions: pd.DataFrame) -> pd.DataFrame:
        """Return the transitions of the table that have this distance or lack it."""
        if self.hand == "both":
            return counted(transitions)
        return transitions[
            (transitions["hand"] == self.hand)
            & (transitions["segmentation"] == self.segmentation)
            & (transitions["status"] != "overlap")
        ]


def _plans(unit: str) -> list[_Plan]:
    euclidean = f"euclidean_{unit}"
    whole = [_Plan("both", "manual", c) for c in ("geodesic_rad", euclidean, "mean_distance")]
    return whole + [
        _Plan(h, s, euclidean) for h in ("right", "left") for s in ("manual", "refined")
    ]


def _distances(
    transitions: pd.DataFrame, unit: str, settings: DurationSettings, rng: np.random.Generator
) -> list[Finding]:
    chosen = settings.durations
    alpha = chosen.alpha
    out: list[Finding] = []
    exponents: dict[str, Finding] = {}
    for plan in _plans(unit):
        rows = plan.rows(transitions)
        there = rows[rows[plan.column].notna()]
        x, y = (there[c].to_numpy(dtype=float) for c in (plan.column, "duration_s"))
        left = f"{len(rows) - len(there)} without this distance" if len(rows) > len(there) else ""
        found = association.correlations(
            x, y, list(there["recording"]), plan.title, alpha, chosen.draws,
            chosen.bootstrap_recordings, rng,
        )  # fmt: skip
        if plan.column != "mean_distance":
            exponent = association.isochrony(x, y, plan.title, alpha)
            found.append(exponent)
            if plan.hand == "both":
                exponents[plan.column] = exponent
        out += [f.noted(left) for f in found]
    # Seven distances ask whether duration goes with distance, each by two measures.
    for test in (association.PEARSON, association.SPEARMAN):
        out = holm(out, lambda f, test=test: f.test == test)  # type: ignore[misc]
    points, _ = with_flags(
        transitions,
        settings.transitions.outlier_iqr,
        settings.transitions.diamond_share,
    )
    held = points.loc[points["mean_distance"].notna(), "in_diamond"].to_numpy(dtype=bool)
    out.append(association.share(held, "share in the diamond (Fig. 8)", "all", alpha))
    out.append(isochrony_in_words(exponents))
    return out
