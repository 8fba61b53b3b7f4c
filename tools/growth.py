"""What a run costs as recordings grow: `python -m tools.growth FOLDER KIND N [N ...]`.

For each size a corpus is simulated (`signkin simulate`), the workflow runs from nothing on two
cores, runs again with nothing to do, and once more with a recording added. Printed, for each size:
wall and CPU time, the longest and the largest job, jobs, disk; then CPU a recording by rule. Wall
times are those of the machine as it is; CPU times are each job's own.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import pandas as pd


@dataclass(frozen=True)
class Measured:
    """One size: times in s, memory in MB, disk in MB."""

    recordings: int
    jobs: pd.DataFrame
    wall_s: float
    no_op_s: float
    added_s: float
    disk_mb: float

    @property
    def row(self) -> str:
        """A line of the table."""
        longest = self.jobs.loc[self.jobs["cpu_s"].idxmax()]
        largest = self.jobs.loc[self.jobs["peak_mb"].idxmax()]
        cpu = self.jobs["cpu_s"].sum()
        return (
            f"| {self.recordings:,} | {len(self.jobs)} | {self.wall_s:.0f} | {cpu:.0f} | "
            f"{cpu / self.recordings:.2f} | {longest['cpu_s']:.0f} ({longest['rule']}) | "
            f"{largest['peak_mb']:.0f} ({largest['rule']}) | {self.disk_mb:.0f} | "
            f"{self.no_op_s:.0f} | {self.added_s:.0f} |"
        )


HEAD = (
    "| recordings | jobs | wall, s | CPU, s | CPU a recording, s | longest job, CPU s | "
    "largest job, MB | results, MB | nothing to do, s | one added, s |\n"
    "|---|---|---|---|---|---|---|---|---|---|"
)


def signkin(folder: Path, *words: str) -> float:
    """Run a command; returns how long it took."""
    start = time.monotonic()
    done = subprocess.run([sys.executable, "-m", "signkin", *words], cwd=folder, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    if done.returncode:
        raise SystemExit(done.stdout[-3000:])
    return time.monotonic() - start


def jobs(folder: Path) -> pd.DataFrame:
    """Return what each job of the last run cost."""
    costs = [json.loads(p.read_text()) for p in sorted((folder / "logs").rglob("*.cost.json"))]
    return pd.DataFrame(costs)


def measure(folder: Path, kind: str, recordings: int) -> Measured:
    """Simulate a corpus of a size and run it thrice."""
    own = folder / f"{kind}-{recordings}"
    if own.exists():
        shutil.rmtree(own)
    own.mkdir(parents=True)
    signkin(own, "simulate", ".", "--recordings", str(recordings + 1), "--kind", kind)
    table = own / "corpora" / kind / "recordings.csv"
    rows = table.read_text().splitlines(keepends=True)
    table.write_text("".join(rows[:-1]))
    wall = signkin(own, "run", "--cores", "2")
    costs = jobs(own)
    size = sum(p.stat().st_size for p in (own / "results").rglob("*") if p.is_file()) / 1e6
    no_op = signkin(own, "run", "--cores", "2")
    table.write_text("".join(rows))
    added = signkin(own, "run", "--cores", "2")
    return Measured(recordings, costs, wall, no_op, added, size)


def main() -> None:
    """Print the tables."""
    folder, kind, sizes = Path(sys.argv[1]), sys.argv[2], [int(n) for n in sys.argv[3:]]
    print(HEAD, flush=True)
    all_measured = []
    for size in sizes:
        all_measured.append(measure(folder, kind, size))
        print(all_measured[-1].row, flush=True)
    by_rule = pd.DataFrame({
        f"{m.recordings:,}": m.jobs.groupby("rule")["cpu_s"].sum() / m.recordings
        for m in all_measured
    }).round(3)  # fmt: skip
    worst = by_rule.sort_values(by_rule.columns[-1], ascending=False)
    print("\nCPU a recording, s, by rule:\n\n| rule | " + " | ".join(by_rule) + " |")
    print("|---" * (1 + len(by_rule.columns)) + "|")
    for rule, values in worst.iterrows():
        print(f"| {rule} | " + " | ".join(f"{v:.3f}" for v in values) + " |")


if __name__ == "__main__":
    main()
