"""Models of transition duration (Naert et al. 2017, section 5.2).

All share one base, `DurationModel`: `fit(transitions)`, then `predict(transitions)`, where
`Transitions` holds the arrays. Distances may be in any unit, as long as it is the same in fit,
predict and speeds (the pipeline: radians, and Euclidean over `euclidean_unit_m`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field, fields
from typing import Self

import numpy as np
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba
from numpy.typing import NDArray

from signkin.errors import SignkinError

TERMS = ("constant", "geodesic", "euclidean")
LINEAR_TERMS = ("constant", "mean_distance")
MOST_LEFT_OUT = 1000  # groups that are left out one by one
FOLDS = 100  # of more groups

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Transitions:
    """What models learn from and predict for: arrays (N,), speeds (N, 2); NaN is missing.

    geodesic: eq. 1, rad. euclidean: eq. 2, any unit. duration_s: seconds; only `fit` wants it.
    linear_speed, angular_speed: means over the joints and frames of the sign before and of the
    sign after, in distance units a second and rad/s measured as eq. 1 measures angles; only
    SIMPLE and SIMPLE_BOUNDED want them. What is not given is NaN; numbers stand for arrays of
    one. Raises SignkinError where lengths differ.
    """

    geodesic: Array
    euclidean: Array
    duration_s: Array = field(default_factory=lambda: np.empty(0))
    linear_speed: Array = field(default_factory=lambda: np.empty((0, 2)))
    angular_speed: Array = field(default_factory=lambda: np.empty((0, 2)))

    def __post_init__(self) -> None:
        """Turn all into arrays of one length."""
        n = np.size(self.euclidean)
        for part in fields(self):
            wide = (n, 2) if part.name.endswith("speed") else (n,)
            value = np.asarray(getattr(self, part.name), dtype=float)
            if value.size == 0 and n:
                value = np.full(wide, np.nan)
            if value.size == np.prod(wide) and value.ndim < len(wide):
                value = value.reshape(wide)
            if value.shape != wide:
                raise SignkinError(
                    f"{part.name} has shape {value.shape}",
                    place="transitions",
                    expected=f"{wide}"
                    + (": the sign before, the sign after" if len(wide) == 2 else ""),
                )
            object.__setattr__(self, part.name, value)

    def __len__(self) -> int:
        """Return the number of transitions."""
        return len(self.duration_s)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Transitions:
        """Return some of the transitions."""
        return Transitions(*(getattr(self, part.name)[chosen] for part in fields(self)))

    def teach(self, model: DurationModel) -> DurationModel:
        """Fit a model to these transitions and return it."""
        return model.fit(self)

    def ask(self, model: DurationModel) -> Array:
        """Return what a model predicts for these transitions, in s, (N,)."""
        return model.predict(self)


class DurationModel(ABC):
    """What every model of duration can do.

    A model is made without data, learns from transitions with durations and then predicts.
    Both raise SignkinError where the transitions do not have what the model wants.
    """

    @abstractmethod
    def fit(self, transitions: Transitions) -> Self:
        """Learn from transitions and return the model itself."""

    @abstractmethod
    def predict(self, transitions: Transitions) -> Array:
        """Return durations in seconds, (N,)."""


def simple_weight(alpha: float, geodesic: bool) -> float:
    """Return SIMPLE's weight of the Euclidean part for a corpus with or without geodesic distance.

    Without (no orientations) there is nothing but the Euclidean part, as LINEAR too has but the
    one distance then.
    """
    return alpha if geodesic else 1.0


@dataclass
class SimpleDuration(DurationModel):
    """SIMPLE_DURATION (eq. 3): distance over the mean speed of the two surrounding signs.

    duration = alpha 2 E / (v1 + v2) + (1 - alpha) 2 G / (w1 + w2). Nothing is learnt: `fit`
    returns the model as it is. alpha, 0 to 1: weight of the Euclidean part, which the paper does
    not print. A part with weight 0 needs neither its distance nor its speeds.
    """

    alpha: float = 0.5

    def __post_init__(self) -> None:
        """Refuse a weight outside 0 to 1."""
        if not 0 <= self.alpha <= 1:
            raise SignkinError(f"alpha is {self.alpha:g}", place="SIMPLE", expected="0 to 1")

    def fit(self, transitions: Transitions) -> Self:
        """Return the model itself: eq. 3 has nothing to learn."""
        return self

    def predict(self, transitions: Transitions) -> Array:
        """Return durations in seconds, (N,); signs without speed are an error."""
        total = np.zeros(len(transitions))
        for weight, distance, speed in (
            (self.alpha, "euclidean", "linear_speed"),
            (1 - self.alpha, "geodesic", "angular_speed"),
        ):
            if weight:
                total = total + weight * _travel_time(
                    getattr(transitions, distance), getattr(transitions, speed), speed
                )
        return total


@dataclass
class SimpleBoundedDuration(SimpleDuration):
    """SIMPLE_BOUNDED_DURATION: eq. 3, put to `low_s` below it and to `high_s` above it."""

    low_s: float = 0.1
    high_s: float = 0.5

    def __post_init__(self) -> None:
        """Refuse bounds that hold nothing."""
        super().__post_init__()
        if not 0 <= self.low_s < self.high_s:
            raise SignkinError(
                f"the bounds are {self.low_s:g} and {self.high_s:g} s",
                place="SIMPLE_BOUNDED",
                expected="0 <= low_s < high_s",
            )

    def predict(self, transitions: Transitions) -> Array:
        """Return durations in seconds, (N,), as `SimpleDuration.predict`, within the bounds."""
        return np.asarray(np.clip(super().predict(transitions), self.low_s, self.high_s))


@dataclass
class LinearDuration(DurationModel):
    """LINEAR_DURATION: the straight line of Fig. 7 over the mean of the normalised distances.

    Each distance has its mean taken off and is divided by its range (5.1), both learnt in
    `fit`. Where a corpus has no geodesic distance at all (all NaN), the mean is the Euclidean
    one, as in transitions.csv. theta: intercept (s) and slope (s a unit of mean distance).
    """

    theta: Array = field(default_factory=lambda: np.full(2, np.nan))
    standard_error: Array = field(default_factory=lambda: np.full(2, np.nan))
    centre: Array = field(default_factory=lambda: np.full(2, np.nan))
    span: Array = field(default_factory=lambda: np.full(2, np.nan))
    n: int = 0
    mean_error_s: float = float("nan")

    def fit(self, transitions: Transitions) -> Self:
        """Fit to transitions; fewer than three, or distances that do not vary, are an error."""
        y = transitions.duration_s
        pair = (transitions.geodesic, transitions.euclidean)
        there = [not np.isnan(d).all() for d in pair]
        used = [d for d, t in zip(pair, there, strict=True) if t]
        if not used or not (np.isfinite(y).all() and all(np.isfinite(d).all() for d in used)):
            raise _missing("LINEAR")
        if len(y) < 3 or all(np.ptp(d) == 0 for d in used):
            raise SignkinError(
                f"no line through {len(y)} transitions",
                place="LINEAR",
                expected="three transitions or more whose distances differ",
            )
        self.centre = np.array(
            [d.mean() if t else np.nan for d, t in zip(pair, there, strict=True)]
        )
        self.span = np.array(
            [(np.ptp(d) or 1.0) if t else np.nan for d, t in zip(pair, there, strict=True)]
        )
        x = self.mean_distance(transitions)
        if np.ptp(x) <= 1e-12:
            raise SignkinError(
                "the mean of the normalised distances does not vary",
                place="LINEAR",
                expected="distances that do not cancel each other",
            )
        line = scipy.stats.linregress(x, y)
        self.theta = np.array([line.intercept, line.slope])
        self.standard_error = np.array([line.intercept_stderr, line.stderr])
        self.n = len(y)
        self.mean_error_s = float(np.mean(np.abs(y - self.predict(transitions))))
        return self

    def mean_distance(self, transitions: Transitions) -> Array:
        """Return the mean of the two distances, normalised as learnt; of the one, if so learnt."""
        pair = (transitions.geodesic, transitions.euclidean)
        parts = [
            (d - c) / s
            for d, c, s in zip(pair, self.centre, self.span, strict=True)
            if not np.isnan(c)
        ]
        return np.asarray(sum(parts) / len(parts), dtype=float)

    def predict(self, transitions: Transitions) -> Array:
        """Return durations in seconds, (N,)."""
        _refuse_unfitted(self.theta, "LINEAR")
        return np.asarray(self.theta[0] + self.theta[1] * self.mean_distance(transitions))


@dataclass
class SurfaceDuration(DurationModel):
    """SURFACE_DURATION (eq. 4): duration = theta_0 + theta_1 geodesic + theta_2 Euclidean.

    The least-squares solution of the paper's normal equations, by a QR decomposition, which
    gives the same theta without squaring the condition number. Distances in the units that
    theta is wanted in (the pipeline: radians, and Euclidean over `euclidean_unit_m`). The
    printed surface: `SurfaceDuration(theta=np.array([0.148777, 0.663958, 0.275229]))`.
    """

    theta: Array = field(default_factory=lambda: np.full(3, np.nan))
    standard_error: Array = field(default_factory=lambda: np.full(3, np.nan))
    n: int = 0
    mean_error_s: float = float("nan")

    def fit(self, transitions: Transitions) -> Self:
        """Fit to transitions: singular or too few equations are an error."""
        y = transitions.duration_s
        x = np.column_stack([np.ones(len(y)), transitions.geodesic, transitions.euclidean])
        if not (np.isfinite(x).all() and np.isfinite(y).all()):
            raise _missing("surface")
        if len(y) < 4 or np.linalg.matrix_rank(_scaled(x)) < 3:
            raise SignkinError(
                f"the normal equations of {len(y)} transitions are singular",
                place="surface",
                expected="four transitions or more whose distances do not lie on one line",
            )
        q, r = np.linalg.qr(x)
        self.theta = np.linalg.solve(r, q.T @ y)
        residual = y - x @ self.theta
        self.n = len(y)
        self.mean_error_s = float(np.mean(np.abs(residual)))
        inverse = np.linalg.inv(r)
        variance = residual @ residual / (self.n - 3)
        self.standard_error = np.sqrt(variance * (inverse**2).sum(axis=1))
        return self

    def interval(self, level: float = 0.95) -> Array:
        """Return the confidence interval of each coefficient, (3, 2), by Student's t."""
        half = scipy.stats.t.ppf(0.5 + level / 2, self.n - 3) * self.standard_error
        return np.column_stack([self.theta - half, self.theta + half])

    def predict(self, transitions: Transitions) -> Array:
        """Return predicted durations in seconds, (N,)."""
        _refuse_unfitted(self.theta, "surface")
        return np.asarray(
            self.theta[0]
            + self.theta[1] * transitions.geodesic
            + self.theta[2] * transitions.euclidean
        )


@dataclass
class PrintedSurface(SurfaceDuration):
    """The surface with the theta that the paper prints: it learns nothing."""

    def fit(self, transitions: Transitions) -> Self:
        """Return the model itself."""
        return self


@dataclass
class MeanDuration(DurationModel):
    """The baseline that any model has to beat: the mean duration, whatever the distance."""

    mean_s: float = float("nan")

    def fit(self, transitions: Transitions) -> Self:
        """Take the mean of the durations."""
        y = transitions.duration_s
        if not len(y) or not np.isfinite(y).all():
            raise _missing("MEAN")
        self.mean_s = float(y.mean())
        return self

    def predict(self, transitions: Transitions) -> Array:
        """Return the mean, once for each transition, (N,)."""
        _refuse_unfitted(np.array([self.mean_s]), "MEAN")
        return np.full(len(transitions), self.mean_s)


def folded(groups: Sequence[Hashable]) -> tuple[Sequence[Hashable], str]:
    """Return groups to leave out in a time that data do not square, and what to tell of it.

    Up to MOST_LEFT_OUT of them stay as they are. More are put into FOLDS folds in turn, by where
    they first occur, and a fold is left out as a whole: a model then learns from 99 % of the data.
    """
    labels = list(dict.fromkeys(groups))
    if len(labels) <= MOST_LEFT_OUT:
        return groups, ""
    fold = {label: i % FOLDS for i, label in enumerate(labels)}
    told = f"{FOLDS} folds: {len(labels)} are more than {MOST_LEFT_OUT} to leave out one by one"
    return [fold[label] for label in groups], told


def predict_left_out(
    make: Callable[[], DurationModel], data: Transitions, groups: Sequence[Hashable]
) -> Array:
    """Return predictions for each group by a model that learnt from all other groups, (N,).

    groups: one label a transition; all labels different is leave-one-out, a recording's name
    is leave-one-recording-out. Raises SignkinError for fewer than two groups.
    """
    labels = list(dict.fromkeys(groups))
    if len(labels) < 2:
        raise SignkinError(
            f"{len(labels)} group to leave out", place="cross-validation", expected="two or more"
        )
    place = {label: i for i, label in enumerate(labels)}
    member = np.array([place[label] for label in groups])
    out = np.full(len(data), np.nan)
    for i in range(len(labels)):
        held = member == i
        out[held] = make().fit(data[~held]).predict(data[held])
    return out


def _travel_time(distance: Array, speeds: Array, name: str) -> Array:
    if len(speeds) and np.isnan(speeds).all():
        raise SignkinError(
            f"no {name}",
            place="SIMPLE",
            expected="the mean speeds of the signs before and after, (N, 2)",
        )
    total = speeds.sum(axis=-1)
    if (total <= 0).any():
        raise SignkinError(
            f"{name} is 0 or less for {int((total <= 0).sum())} transitions",
            place="SIMPLE",
            expected="signs that move: eq. 3 divides by their speed",
        )
    return np.asarray(2 * distance / total)


def _missing(place: str) -> SignkinError:
    return SignkinError(
        "a distance or duration is missing",
        place=place,
        expected="transitions with both distances and a duration",
    )


def _refuse_unfitted(theta: Array, place: str) -> None:
    if np.isnan(theta).any():
        raise SignkinError("the model is not fitted", place=place, todo="Call fit() first.")


def _scaled(x: Array) -> Array:
    size = np.linalg.norm(x, axis=0)
    return x / np.where(size > 0, size, 1.0)
