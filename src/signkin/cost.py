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
        unfinished = path.with_suffix(".part")  # a killed job leaves no half of it
        unfinished.write_text(json.dumps(cost) + "\n", encoding="utf-8")
        unfinished.replace(path)


def _peak_mb() -> float | None:
    if sys.platform == "win32":
        return None  # the module is not there
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1e6 if sys.platform == "darwin" else 1e3), 1)


def failure(logs: Path, since: float) -> str:
    """Return which step of a run failed, why in one sentence and where its log is; '' for none.

    since: when the run began; of several, the first that failed is told.
    """
    found = []
    for path in logs.rglob("*.log") if logs.is_dir() else ():
        if path.stat().st_mtime >= since and path.with_suffix(SUFFIX).is_file():
            text = path.read_text(encoding="utf-8", errors="replace")
            lines = [line for line in text.splitlines() if line.strip()]
            why = [line for line in lines if line.startswith("signkin: ")]
            if why or any(line.startswith("Traceback") for line in lines):
                told = why[-1] if why else lines[-1]
                found.append((path.stat().st_mtime, told.removeprefix("signkin: "), path))
    if not found:
        return ""
    _, why_, path = min(found)
    cost = json.loads(path.with_suffix(SUFFIX).read_text(encoding="utf-8"))
    about = f" ({cost['about']})" if cost["about"] else ""
    return f"signkin: the step {cost['rule']}{about} failed: {why_}\nIts log: {path}"


def read_costs(logs: Path) -> list[dict[str, object]]:
    """Return what was noted below a folder of logs, in order of name."""
    return [
        json.loads(path.read_text(encoding="utf-8")) for path in sorted(logs.rglob(f"*{SUFFIX}"))
    ]
