"""A child process that does not outlive the command, and holds its lock while it lives."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import FrameType

FORWARDED = ("SIGTERM", "SIGHUP")
_PR_SET_PDEATHSIG = 1


def run_child(
    command: Sequence[str], folder: Path, environment: Mapping[str, str], keep: int
) -> int:
    """Run a command to its end; returns its exit status.

    keep: file descriptor that the child inherits. A lock on it is the child's too, so that it stays
    while the child lives, whatever becomes of this process. Signals that end this process are sent
    on, and the child is waited for; a second interrupt ends it at once. Where this process is
    killed outright, Linux tells the child.
    """
    posix = sys.platform != "win32"
    child = subprocess.Popen(
        command, cwd=folder, env=dict(environment), pass_fds=(keep,) if posix else (),
        preexec_fn=end_with_parent if sys.platform == "linux" else None,
    )  # fmt: skip

    def forward(number: int, frame: FrameType | None) -> None:
        child.terminate()  # not the same signal: under nohup the child would ignore SIGHUP

    before = {
        number: signal.signal(number, forward)
        for name in FORWARDED
        if (number := getattr(signal, name, None)) is not None
    }
    interrupts = 0
    try:
        while True:
            try:
                return child.wait()
            except KeyboardInterrupt:
                # From a terminal the child has it too; sent to this process alone, it has not.
                interrupts += 1
                if interrupts == 1:
                    child.terminate()
                else:
                    child.kill()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def end_with_parent() -> None:
    """Ask the kernel for SIGTERM when the parent dies."""
    import ctypes

    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
