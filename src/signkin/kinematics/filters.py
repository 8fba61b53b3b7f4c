"""Low-pass filters without delay.

Both kinds have half the gain (-6 dB) at `cutoff_hz` as they are applied: the
Butterworth filter runs forwards and backwards (two times -3 dB), the FIR filter
is designed for it. The FIR filter is the one of Endres et al. 2013, section
2.2 ("50-samples 6 Hz low pass FIR filter, normalized gain of -6 dB at 6 Hz"),
with an odd number of taps so that its delay is a whole number of samples.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy  # loads scipy.signal when it is used: it takes as long to import as numba
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.kinematics.gaps import stretches
from signkin.masked import unmasked

METHODS = ("butterworth", "fir")
FIR_LENGTH_S = 51 / 240  # 50 samples at 240 Hz, made odd
LOWEST_FIR_RATE_HZ = 15.0  # below it the filter has too few taps to be one


def lowpass(
    x: NDArray[np.float64],
    rate_hz: float,
    cutoff_hz: float,
    method: str = "butterworth",
    order: int = 2,
) -> NDArray[np.float64]:
    """Low-pass the columns of `x` along its first axis, without delay.

    x: (F, ...), any unit; gaps (NaN) stay, and each stretch between them is filtered alone.
    cutoff_hz: where the gain is one half. order: of the Butterworth filter, before it is
    run in both directions. Edges are mirrored through their end point (odd extension).
    """
    if method not in METHODS:
        raise SignkinError(
            f"the filter is {method!r}", place="lowpass.method", expected=listed(METHODS)
        )
    if not 0 < cutoff_hz < rate_hz / 2:
        raise SignkinError(
            f"a cut-off of {cutoff_hz:g} Hz at {rate_hz:g} Hz",
            place="lowpass.cutoff_hz",
            expected=f"above 0 and below {rate_hz / 2:g} Hz, half the rate",
        )
    flat = unmasked(x).reshape(len(x), -1)
    out = np.full_like(flat, np.nan)
    taps = _taps(rate_hz, cutoff_hz) if method == "fir" else None
    there = ~np.isnan(flat)
    # Columns with the same gaps (a joint's axes) go through the filter together.
    for columns in _alike(there):
        for first, end in stretches(there[:, columns[0]]):
            piece = flat[first:end, columns]
            if taps is not None:
                filtered = np.column_stack([_centred(column, taps) for column in piece.T])
            else:
                # Long enough for the filter to settle (the usual padding is too short for low
                # cut-offs); shorter for pieces that are.
                pad = min(int(np.ceil(3 * rate_hz / cutoff_hz)), len(piece) - 1)
                sos = _sections(order, cutoff_hz, rate_hz)
                filtered = scipy.signal.sosfiltfilt(sos, piece, axis=0, padlen=pad)
            out[first:end, columns] = filtered
    return out.reshape(np.shape(x))


def _alike(there: NDArray[np.bool_]) -> list[list[int]]:
    groups: dict[bytes, list[int]] = {}
    for column in range(there.shape[1]):
        groups.setdefault(there[:, column].tobytes(), []).append(column)
    return list(groups.values())


@lru_cache(maxsize=64)
def _sections(order: int, cutoff_hz: float, rate_hz: float) -> NDArray[np.float64]:
    return np.asarray(scipy.signal.butter(order, cutoff_hz, fs=rate_hz, output="sos"))


@lru_cache(maxsize=64)
def _taps(rate_hz: float, cutoff_hz: float) -> NDArray[np.float64]:
    return fir_taps(rate_hz, cutoff_hz)


def _centred(piece: NDArray[np.float64], taps: NDArray[np.float64]) -> NDArray[np.float64]:
    half = len(taps) // 2
    pad = min(half, len(piece) - 1)
    head = 2 * piece[0] - piece[pad:0:-1]
    tail = 2 * piece[-1] - piece[-2 : -2 - pad : -1] if pad else piece[:0]
    extended = np.concatenate([head, piece, tail])
    extended = np.pad(extended, half - pad, mode="edge")
    return np.convolve(extended, taps, mode="valid")


def fir_taps(
    rate_hz: float, cutoff_hz: float, length_s: float = FIR_LENGTH_S
) -> NDArray[np.float64]:
    """Return the taps of a linear-phase low-pass with a gain of exactly 1/2 at `cutoff_hz`.

    Hamming-windowed sinc of odd length, nearest to `length_s`; the design frequency is
    solved for, since a short window shifts the half-gain point.
    """
    if rate_hz < LOWEST_FIR_RATE_HZ:
        raise SignkinError(
            f"a rate of {rate_hz:g} Hz",
            place="lowpass",
            expected=f"{LOWEST_FIR_RATE_HZ:g} Hz or more for the FIR filter",
        )
    n_taps = 2 * round((length_s * rate_hz - 1) / 2) + 1

    def gain_error(design_hz: float) -> float:
        return _gain(scipy.signal.firwin(n_taps, design_hz, fs=rate_hz), cutoff_hz, rate_hz) - 0.5

    low, high = 1e-3 * cutoff_hz, 0.499 * rate_hz
    if gain_error(low) > 0:
        raise SignkinError(
            f"{n_taps} taps at {rate_hz:g} Hz pass more than half at {cutoff_hz:g} Hz",
            place="lowpass.cutoff_hz",
            expected="a higher cut-off, or the Butterworth filter",
        )
    return np.asarray(
        scipy.signal.firwin(n_taps, scipy.optimize.brentq(gain_error, low, high), fs=rate_hz)
    )


def _gain(taps: NDArray[np.float64], frequency_hz: float, rate_hz: float) -> float:
    return float(np.abs(scipy.signal.freqz(taps, worN=[frequency_hz], fs=rate_hz)[1][0]))


def response_db(
    frequencies_hz: NDArray[np.float64],
    rate_hz: float,
    cutoff_hz: float,
    method: str = "butterworth",
    order: int = 2,
) -> NDArray[np.float64]:
    """Return the gain in dB that `lowpass` applies at each frequency."""
    if method == "fir":
        gain = np.abs(
            scipy.signal.freqz(fir_taps(rate_hz, cutoff_hz), worN=frequencies_hz, fs=rate_hz)[1]
        )
    else:
        b, a = scipy.signal.butter(order, cutoff_hz, fs=rate_hz)
        gain = np.abs(scipy.signal.freqz(b, a, worN=frequencies_hz, fs=rate_hz)[1]) ** 2
    return np.asarray(20 * np.log10(np.maximum(gain, 1e-300)))
