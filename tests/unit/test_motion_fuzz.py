"""Every reader against damaged files: a recording, or a SignkinError, within five seconds.

Seeded; `SIGNKIN_FUZZ=10000 pytest tests/unit/test_motion_fuzz.py` tries more than the usual 500
files a format.
"""

from __future__ import annotations

import os
import random
import resource
import signal
import warnings
from pathlib import Path

import numpy as np
import pytest

from signkin import Recording, SignkinError, read_recording
from support.motion_files import SAMPLES, motion

TRIES = int(os.environ.get("SIGNKIN_FUZZ", "500"))
LONGEST_S = 5
MOST_BYTES = 1 << 30
NASTY = (
    b"nan", b"inf", b"-inf", b"1e999", b"1e308", b"-1e308", b"1e-320", b"1000000000", b"-1", b"0",
    b"", b"\0", b"\xff", b"\xe9", b"\xef\xbb\xbf", b"\xff\xfe", b'"', b"'", b"{", b"}", b",", b";",
    b"\t", b" ", b"\n", b"\r", b"\n\n", b"1,5", b"1_0", b"0x10", b"999999999999999999999999", b".",
    b"[", b"]", b"{}", b"null", b"true", b"x" * 300, b"\xe2\x80\xa8", b"Infinity",
)  # fmt: skip


def damaged(content: bytes, rng: random.Random) -> bytes:
    """Return a file as programs, transfers and hands damage it."""
    out = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 4, 16))):
        at = rng.randrange(len(out) + 1)
        # Headers are short and matter most.
        if rng.random() < 0.5:
            at = rng.randrange(min(len(out), 600) + 1)
        kind = rng.randrange(8)
        if kind == 0 and out:
            out[min(at, len(out) - 1)] = rng.randrange(256)
        elif kind == 1:
            del out[at : at + rng.choice((1, 1, 2, 8, 100))]
        elif kind == 2:
            out[at:at] = rng.choice(NASTY)
        elif kind == 3:
            out = out[:at]
        elif kind == 4:  # a line twice, or gone, or moved
            lines = bytes(out).split(b"\n")
            i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
            moved = lines[i] if rng.random() < 0.6 else lines.pop(i)
            if rng.random() < 0.7:
                lines.insert(j, moved)
            out = bytearray(b"\n".join(lines))
        elif kind == 5:  # a word replaced
            words = bytes(out).split(b" ") if b"," not in out else bytes(out).split(b",")
            words[rng.randrange(len(words))] = rng.choice(NASTY)
            out = bytearray((b"," if b"," in out else b" ").join(words))
        elif kind == 6:
            out[at:at] = out[at : at + rng.choice((4, 30, 200))]
        else:
            end = min(len(out), at + 4)
            out[at:end] = rng.choice(
                (b"\xff" * 4, b"\0" * 4, b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f")
            )[: end - at]
    return bytes(out)


class _TooLong(Exception):
    """A reader that does not come back."""


def _stop(*_: object) -> None:
    raise _TooLong(f"no answer after {LONGEST_S} s")


@pytest.mark.parametrize("name", SAMPLES)
def test_damaged_files_end_in_a_recording_or_a_sentence(tmp_path, name):
    sample = SAMPLES[name]
    path = tmp_path / sample.name
    sample.write(path, motion(6))
    victim = sorted(path.iterdir())[2] if path.is_dir() else path
    whole = victim.read_bytes()
    rng = random.Random(f"signkin {name}")
    outcome = {"read": 0, "refused": 0}
    # The peak of the process: another test may have had it already, and then it may not grow.
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    before = signal.signal(signal.SIGALRM, _stop)
    try:
        for number in range(TRIES):
            content = damaged(whole, rng)
            victim.write_bytes(content)
            signal.alarm(LONGEST_S)
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("error", RuntimeWarning)
                    recording = read_recording(path, format=sample.format, **sample.spec)
                _look_at(recording)
                outcome["read"] += 1
            except SignkinError as error:
                assert len(str(error)) < 3000 and "\n" not in str(error), error
                outcome["refused"] += 1
            except BaseException:
                kept = Path(os.environ.get("SIGNKIN_FUZZ_KEEP", tmp_path)) / f"{name}-{number}"
                kept.write_bytes(content)
                print(f"{name}: mutation {number}, kept as {kept}")
                raise
            finally:
                signal.alarm(0)
    finally:
        signal.signal(signal.SIGALRM, before)
    # Both happen, or the damage is none or total, and the test tells nothing.
    assert outcome["refused"] > TRIES // 10 and outcome["read"] > TRIES // 100, outcome
    most = max(peak, MOST_BYTES)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 <= most


def _look_at(recording: Recording) -> None:
    """Hold what was read to what every recording promises."""
    assert recording.frames >= 2 and recording.rate_hz > 0
    assert not np.isinf(recording.positions).any()
