"""Manual tags as posteriors: where each boundary is, and how sure that is (`refine_posterior`).

Naert et al. (2017, section 4.2) move a tag to the nearest minimum of speed. Here the tag and the
minima about it are weighed against each other, for all tags of a recording together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from signkin.coarticulation.tag_model import (
    DEPTHS,
    FEWEST,
    MOST_GROSS,
    REACH_S,
    STEP_S,
    Tagged,
    TagModel,
    learnt,
    minima_about,
    near_minima,
    posterior,
)
from signkin.errors import SignkinError
from signkin.masked import unmasked

Floats = NDArray[np.float64]
# Times, classes of depth, and rests (M, 2) where they are known.
Minima = tuple[Floats, NDArray[np.int64], Floats | None]
OFF_S = 0.1  # a tag further than this from its boundary is off
NO_MINIMUM = "this hand has no speed minimum: the tag's own uncertainty"
FEW = f"fewer than {FEWEST} tags: the model is as given, not learnt"
BACKWARDS = "its end is not after its start: left out"
SHARED = "at one instant with another tag: one boundary"
OVERLAPS = "tags of two signs overlap: they keep the order of their times"
UNTIMED = "no time"


@dataclass(frozen=True, eq=False)
class RefinedPosterior:
    """Where the boundaries of N signs are, seconds; NaN for a tag that was left out.

    mean_s: (N, 2) of start and end. interval50_s, interval90_s: (N, 2, 2), low and high, with
    equal probability outside on either side. off: (N, 2), probability that the boundary is more
    than 0.1 s from the tag. grid_s, probability: (N, 2, W), the posterior itself.
    own_minimum: (N, 2), probability that the boundary shows as a minimum of speed.
    notes: (N, 2), what is to be said of a tag; empty where nothing is.
    model: what was learnt (or given). log_likelihood: of tags and minima under it.
    """

    mean_s: Floats
    interval50_s: Floats
    interval90_s: Floats
    off: Floats
    grid_s: Floats
    probability: Floats
    own_minimum: Floats
    notes: NDArray[np.object_]
    model: TagModel
    log_likelihood: float


def refine_posterior(
    intervals_s: ArrayLike,
    minima_s: ArrayLike,
    prominence: ArrayLike | None = None,
    *,
    rests_s: ArrayLike | None = None,
    acts: ArrayLike | None = None,
    model: TagModel | None = None,
    evidence: ArrayLike | None = None,
    evidence_rate_hz: float | None = None,
) -> RefinedPosterior:
    """Return the posterior of each boundary of one hand in one recording.

    intervals_s: (N, 2) manual starts and ends of signs, s. minima_s: (M,) minima of the hand's
    speed. prominence: (M,) their depth, any unit; without, all count alike. rests_s: (M, 2), where
    the hand rests near each, and the SD of that, as `signkin.kinematics.rest_times` finds both
    (as columns); without, minima are all that is known. acts: (N,) whether the hand does anything
    in the sign; tags of a sign in which it does not teach nothing of jitter.
    model: as `learn_tag_model` returns it, for several recordings or two annotators; None: learnt
    from this recording. evidence: (F,), another probability of a boundary in each frame (as
    binning gives it), `evidence_rate_hz` frames a second from 0 s. It counts as independent of the
    minima, which it is not where both come from one speed: give it a power below 1 then.

    Boundaries keep the order of the tags in time; tags at one instant are one boundary. Without a
    minimum the posterior is what is known of the tag alone, in order. Raises SignkinError for
    minima without a time and for arrays that do not fit.
    """
    tags, found_minima = _checked(intervals_s, minima_s, prominence, rests_s)
    notes = _notes(tags, len(found_minima[0]))
    usable = np.array([BACKWARDS not in n and UNTIMED not in n for n in notes.ravel()], dtype=bool)
    usable = usable.reshape(tags.shape)
    given = TagModel() if model is None else model
    if not usable.any():
        return _nothing(tags, notes, given)
    times, edge, idle, boundary_of = _boundaries(tags, usable, acts)
    tagged = _tagged(times, edge, idle, found_minima)
    if evidence is not None:
        tagged = replace(tagged, evidence=_evidence(tagged, evidence, evidence_rate_hz))
    if model is None:
        if len(times) < FEWEST:
            notes[usable] = [_joined(note, FEW) for note in notes[usable]]
        given = learnt([tagged], given)
    own = minima_about(tagged)
    joint, log = posterior(tagged, given, own, near_minima(tagged, own, given))
    found = _nothing(tags, notes, given, log)
    p = joint.sum(axis=1)
    found.grid_s[usable] = tagged.grid_s[boundary_of]
    found.probability[usable] = p[boundary_of]
    found.mean_s[usable] = (p * tagged.grid_s).sum(axis=1)[boundary_of]
    for into, levels in ((found.interval50_s, (0.25, 0.75)), (found.interval90_s, (0.05, 0.95))):
        into[usable] = quantiles(p, tagged.grid_s, levels, tagged.step_s)[boundary_of]
    away = np.abs(tagged.grid_s - times[:, None])
    found.off[usable] = np.where(away > OFF_S, p, 0).sum(axis=1)[boundary_of]
    with_none = np.minimum(joint[:, 0].sum(axis=1), 1.0)  # rounding
    found.own_minimum[usable] = 1 - with_none[boundary_of]
    return found


def learn_tag_model(
    recordings: Sequence[tuple[ArrayLike, ArrayLike, ArrayLike | None]],
    model: TagModel | None = None,
    *,
    rests_s: Sequence[ArrayLike] | None = None,
    acts: Sequence[ArrayLike] | None = None,
    jitter_known: bool = False,
) -> TagModel:
    """Learn how tags and minima of one hand lie about boundaries, from several recordings.

    recordings: (intervals_s, minima_s, prominence) of each, as `refine_posterior` has them.
    rests_s, acts: of each recording, as there. model: where to start; what is not learnt stays (see
    `TagModel`), the jitter too where it is known, as from two annotators (`jitter_between`).
    """
    sets = []
    for number, (intervals, minima_s, prominence) in enumerate(recordings):
        rests = None if rests_s is None else rests_s[number]
        tags, found_minima = _checked(intervals, minima_s, prominence, rests)
        forward = np.repeat((tags[:, 1] > tags[:, 0])[:, None], 2, axis=1)
        if forward.any():
            acting = None if acts is None else acts[number]
            times, edge, idle, _ = _boundaries(tags, forward, acting)
            sets.append(_tagged(times, edge, idle, found_minima))
    return learnt(sets, TagModel() if model is None else model, jitter_known=jitter_known)


def jitter_between(first_s: ArrayLike, second_s: ArrayLike) -> TagModel:
    """Return a model with the jitter of two annotators of the same signing, taken as alike.

    first_s, second_s: (N, 2), (M, 2) starts and ends, s. Starts are compared with starts and ends
    with ends, where each is the other's nearest. Their differences have twice the variance of one
    annotator's jitter; it is taken from the median of their absolute size about a common lead,
    which gross errors do not move. Differences beyond four SDs are the gross errors of one or the
    other. A lead that both share cannot be seen; `learn_tag_model` learns it from the minima.
    Raises SignkinError with fewer than FEWEST pairs.
    """
    first, second = (np.asarray(x, dtype=float).reshape(-1, 2) for x in (first_s, second_s))
    differences: list[Floats] = []
    for edge in (0, 1) if len(first) and len(second) else ():
        apart = np.abs(first[:, None, edge] - second[:, edge])
        mine, theirs = apart.argmin(axis=1), apart.argmin(axis=0)
        pairs = np.flatnonzero((theirs[mine] == np.arange(len(first))) & (apart.min(axis=1) < 1))
        found = first[pairs, edge] - second[mine[pairs], edge]
        differences.append(found - np.median(found) if len(found) else found)
    all_ = np.concatenate(differences) if differences else np.empty(0)
    if len(all_) < FEWEST:
        raise _error(f"{len(all_)} pairs of tags of two annotators", f"{FEWEST} or more")
    spread = max(1.4826 * float(np.median(np.abs(all_))), 0.006)
    gross = float(np.mean(np.abs(all_) > 4 * spread)) / 2
    return TagModel(sd_s=spread / np.sqrt(2), gross=float(np.clip(gross, 0.002, MOST_GROSS)))


def quantiles(p: Floats, grid_s: Floats, levels: Sequence[float], step_s: float) -> Floats:
    """Return quantiles of probabilities on a grid, (K, levels), even within a cell of it."""
    below = np.pad(np.cumsum(p, axis=1), ((0, 0), (1, 0)))
    edges = np.concatenate([grid_s - step_s / 2, grid_s[:, -1:] + step_s / 2], axis=1)
    return np.array([np.interp(levels, c, e) for c, e in zip(below, edges, strict=True)])


def _checked(
    intervals_s: ArrayLike,
    minima_s: ArrayLike,
    prominence: ArrayLike | None,
    rests_s: ArrayLike | None,
) -> tuple[Floats, Minima]:
    """Return tags (N, 2), NaN where masked, and minima in order."""
    given: Floats = unmasked(intervals_s)
    tags = given.reshape(-1, 2)
    minima = np.asarray(minima_s, dtype=float).ravel()
    depth = np.zeros(len(minima)) if prominence is None else np.asarray(prominence, dtype=float)
    if depth.shape != minima.shape:
        raise _error(f"{depth.size} depths of {minima.size} minima", "as many of each")
    lost = int((~np.isfinite(minima) | ~np.isfinite(depth)).sum())
    if lost:
        raise _error(f"{lost} of {len(minima)} minima have no time or depth", "numbers")
    order = np.argsort(minima, kind="stable")
    minima, depth = minima[order], depth[order]
    cuts = np.quantile(depth, np.arange(1, DEPTHS) / DEPTHS) if len(depth) else np.empty(0)
    classes = np.searchsorted(cuts, depth)
    if rests_s is None:
        return tags, (minima, classes, None)
    rests = np.asarray(rests_s, dtype=float)
    if rests.shape != (len(minima), 2):
        raise _error(f"rests of shape {rests.shape}", f"({len(minima)}, 2), one a minimum")
    if not (np.isfinite(rests).all() and (rests[:, 1] > 0).all()):
        raise _error("rests without a time, or whose SD is not above 0", "numbers")
    return tags, (minima, classes, rests[order])


def _tagged(times: Floats, edge: Floats, idle: Floats, minima: Minima) -> Tagged:
    at, classes, rests = minima
    if rests is None:
        return Tagged(times, edge, idle, at, classes)
    return Tagged(times, edge, idle, at, classes, rest_s=rests[:, 0], rest_sd_s=rests[:, 1])


def _boundaries(
    tags: Floats, usable: NDArray[np.bool_], acts: ArrayLike | None
) -> tuple[Floats, Floats, Floats, NDArray[np.int64]]:
    """Return times in order; 0 for a start to 1 for an end; 1 for an idle hand; which of all.

    Where two signs share an instant, the edge is between, and the hand acts if in either.
    """
    moving = np.ones(len(tags), dtype=bool) if acts is None else np.asarray(acts, dtype=bool)
    if moving.shape != (len(tags),):
        raise _error(f"acts of shape {moving.shape}", f"({len(tags)},), one a sign")
    times, of = np.unique(tags[usable], return_inverse=True)
    ends = np.broadcast_to([0.0, 1.0], tags.shape)[usable]
    active = np.repeat(moving[:, None], 2, axis=1)[usable]
    idle = np.bincount(of, active) == 0
    return times, np.bincount(of, ends) / np.bincount(of), idle.astype(float), of


def _notes(tags: Floats, minima: int) -> NDArray[np.object_]:
    notes = np.full(tags.shape, "", dtype=object)

    def say(where: NDArray[np.bool_], what: str) -> None:
        notes[where] = [_joined(note, what) for note in notes[where]]

    there = np.isfinite(tags)
    backwards = np.repeat((tags[:, 1] <= tags[:, 0])[:, None], 2, axis=1)
    say(~there, UNTIMED)
    say(backwards, BACKWARDS)
    fine = there & ~backwards
    values, counts = np.unique(tags[fine], return_counts=True)
    say(fine & np.isin(tags, values[counts > 1]), SHARED)
    whole = np.flatnonzero(fine.all(axis=1))
    whole = whole[np.argsort(tags[whole, 0], kind="stable")]
    crossing = tags[whole[1:], 0] < np.maximum.accumulate(tags[whole, 1])[:-1]
    over = np.zeros(tags.shape, dtype=bool)
    over[whole[1:][crossing], 0] = over[whole[:-1][crossing], 1] = True
    say(over, OVERLAPS)
    if not minima:
        say(fine, NO_MINIMUM)
    return notes


def _joined(note: str, more: str) -> str:
    return f"{note}; {more}" if note else more


def _evidence(tagged: Tagged, evidence: ArrayLike, rate_hz: float | None) -> Floats:
    """Return the evidence on the grid, with mean 1 about the tags; 1 outside its frames."""
    p = np.asarray(evidence, dtype=float)
    if p.ndim != 1 or not len(p) or not np.isfinite(p).all() or (p < 0).any():
        raise _error(f"evidence of shape {p.shape}", "(F,) numbers from 0")
    if rate_hz is None or not (np.isfinite(rate_hz) and rate_hz > 0):
        raise _error(f"evidence at {rate_hz} Hz", "evidence_rate_hz above 0")
    frame = tagged.grid_s * rate_hz
    inside = (frame >= 0) & (frame <= len(p) - 1)
    at = np.interp(frame, np.arange(len(p)), p)
    mean = float(at[inside].mean()) if inside.any() else 0.0
    if not mean:
        return np.ones_like(at)
    return np.where(inside, (at + 0.05 * mean) / (1.05 * mean), 1.0)  # 0 rules nothing out


def _nothing(
    tags: Floats, notes: NDArray[np.object_], model: TagModel, log: float = 0.0
) -> RefinedPosterior:
    def empty(*more: int) -> Floats:
        return np.full((*tags.shape, *more), np.nan)

    width = 2 * round(REACH_S / STEP_S) + 1
    return RefinedPosterior(
        empty(), empty(2), empty(2), empty(), empty(width), empty(width), empty(), notes, model, log
    )


def _error(found: str, expected: str) -> SignkinError:
    return SignkinError(found, place="refine_posterior", expected=expected)
