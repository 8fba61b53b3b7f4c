"""Print a process's memory before a fit and its peak, in MB: `memory.py BINS SEGMENTS LONGEST`."""

from __future__ import annotations

import contextlib
import resource
import sys
from pathlib import Path

import numpy as np

from benchmarks.methods import ORDERS, PRIOR
from benchmarks.trajectories import simulate
from signkin.binning import fit


def resident_mb(what: str) -> float:
    """Return VmRSS (now) or VmHWM (peak since its reset); without /proc, the process's peak."""
    status = Path("/proc/self/status")
    if not status.exists():
        size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # bytes on macOS
        return size / 1e6
    line = next(line for line in status.read_text().splitlines() if line.startswith(what))
    return int(line.split()[1]) * 1024 / 1e6


def reset_peak() -> None:
    """Forget the peak so far, where Linux allows it: compilation must not count."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


if __name__ == "__main__":
    bins, segments, longest = (int(word) for word in sys.argv[1:])
    rng = np.random.default_rng(0)
    for short in (100, 300):  # compiles, or loads what was compiled
        fit(simulate(rng, short, 3).x, ORDERS, PRIOR)
    data = simulate(rng, bins, segments)
    reset_peak()
    before = resident_mb("VmRSS")
    fit(data.x, ORDERS, PRIOR, max_segment_bins=longest or None)
    print(before, resident_mb("VmHWM"))
