"""Time and memory of each job, noted beside its log: they differ from run to run."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SUFFIX = ".cost.json"


@contextmanager
def noted(log: str | Path, rule: str, about: str = "") -> Iterator[None]:
    """Note what the block costs in a file beside a log: seconds, CPU seconds, most memory (MB).

    about: of what, `lsf-sim` or `lsf-sim 0001`. Memory is the most that the process ever held.
    """
    start, cpu = time.monotonic(), time.process_time()
    try:
        yield
    finally:
        cost = {
            "rule": rule,
            "about": about,
            "seconds": round(time.monotonic() - start, 3),
            "cpu_s": round(time.process_time() - cpu, 3),
            "peak_mb": _peak_mb(),
        }
        path = Path(log).with_suffix(SUFFIX)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(cost) + "\n", encoding="utf-8")


def _peak_mb() -> float | None:
    if sys.platform == "win32":
        return None  # the module is not there
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1e6 if sys.platform == "darwin" else 1e3), 1)


def read_costs(logs: Path) -> list[dict[str, object]]:
    """Return what was noted below a folder of logs, in order of name."""
    return [
        json.loads(path.read_text(encoding="utf-8")) for path in sorted(logs.rglob(f"*{SUFFIX}"))
    ]
