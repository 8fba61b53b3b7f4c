"""What a run costs as recordings grow: `python -m tools.growth FOLDER KIND N [N ...] [--write]`.

For each size a corpus is simulated (`signkin simulate`), the workflow runs from nothing on two
cores, with nothing to do, with a recording added, and with a key of config.yaml changed. Wall times
are those of the machine as it is; CPU times are each job's own. What was measured stays in FOLDER,
a file a size; `--write` fills the tables of docs/performance.md with all that lies there and draws
docs/images/growth.svg (without sizes: nothing is run anew).
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from tools.marked import fill

PAGE = Path(__file__).parents[1] / "docs" / "performance.md"
FIGURE = PAGE.parent / "images" / "growth.svg"
KINDS = {"tagged": "signing with tags", "signs": "single signs"}
CHANGED = {
    "tagged": ("refinement", "search_window_s", 0.16),
    "signs": ("binning", "hit_window_s", 0.1),
}
SHOWN = 12  # rules, by their CPU at the largest size
HEAD = (
    "| recordings | jobs | wall, s | CPU, s | CPU a recording, s | longest job, CPU s | "
    "largest job, MB | results, MB |\n|---|---|---|---|---|---|---|---|"
)
AGAIN = (
    "| recordings | nothing to do, s | one added: jobs, CPU s, wall s | "
    "one key changed: jobs, CPU s, wall s |\n|---|---|---|---|"
)


@dataclass(frozen=True)
class Again:
    """A run after a change: jobs done, CPU and wall in s."""

    jobs: int
    cpu_s: float
    wall_s: float

    @property
    def told(self) -> str:
        """A cell of a table."""
        return f"{self.jobs}, {self.cpu_s:.0f}, {self.wall_s:.0f}"


@dataclass(frozen=True)
class Measured:
    """One size of a kind of corpus: times in s, disk in MB; costs: of each job of the first run."""

    kind: str
    recordings: int
    costs: list[dict[str, Any]]
    wall_s: float
    disk_mb: float
    no_op_s: float
    added: Again
    changed: Again

    @property
    def jobs(self) -> pd.DataFrame:
        """A row a job; kernels are compiled once for all runs and do not count."""
        frame = pd.DataFrame(self.costs)
        return frame[frame["rule"] != "compile_kernels"]

    @property
    def cpu_s(self) -> float:
        """CPU of a recording."""
        return float(self.jobs["cpu_s"].sum()) / self.recordings

    @property
    def row(self) -> str:
        """A line of the table of first runs."""
        jobs = self.jobs
        longest, largest = jobs.loc[jobs["cpu_s"].idxmax()], jobs.loc[jobs["peak_mb"].idxmax()]
        total = jobs["cpu_s"].sum()
        return (
            f"| {self.recordings:,} | {len(jobs)} | {self.wall_s:.0f} | {total:.0f} | "
            f"{self.cpu_s:.2f} | {longest['cpu_s']:.0f} ({longest['rule']}) | "
            f"{largest['peak_mb']:.0f} ({largest['rule']}) | {self.disk_mb:.0f} |"
        )

    @property
    def row_again(self) -> str:
        """A line of the table of later runs."""
        cells = (f"{self.recordings:,}", f"{self.no_op_s:.0f}", self.added.told, self.changed.told)
        return f"| {' | '.join(cells)} |"


def signkin(folder: Path, *words: str) -> float:
    """Run a command; returns how long it took."""
    start = time.monotonic()
    done = subprocess.run([sys.executable, "-m", "signkin", *words], cwd=folder, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    if done.returncode:
        raise SystemExit(done.stdout[-3000:])
    return time.monotonic() - start


def costs(folder: Path, since: float = 0.0) -> list[dict[str, Any]]:
    """Return what each job cost that ended after a time."""
    paths = sorted((folder / "logs").rglob("*.cost.json"))
    return [json.loads(path.read_text()) for path in paths if path.stat().st_mtime >= since]


def again(folder: Path) -> Again:
    """Run once more, after a change."""
    since = time.time()
    wall = signkin(folder, "run", "--cores", "2")
    done = costs(folder, since)
    return Again(len(done), sum(cost["cpu_s"] for cost in done), wall)


def measure(folder: Path, kind: str, recordings: int) -> Measured:
    """Simulate a corpus of a size and run it four times."""
    own = folder / f"{kind}-{recordings}"
    if own.exists():
        shutil.rmtree(own)
    own.mkdir(parents=True)
    signkin(own, "simulate", ".", "--recordings", str(recordings + 1), "--kind", kind)
    table = own / "corpora" / kind / "recordings.csv"
    rows = table.read_text().splitlines(keepends=True)
    table.write_text("".join(rows[:-1]))
    wall = signkin(own, "run", "--cores", "2")
    first = costs(own)
    size = sum(p.stat().st_size for p in (own / "results").rglob("*") if p.is_file()) / 1e6
    no_op = signkin(own, "run", "--cores", "2")
    table.write_text("".join(rows))
    added = again(own)
    section, key, value = CHANGED[kind]
    config = yaml.safe_load((own / "config.yaml").read_text())
    config[section][key] = value
    (own / "config.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    return Measured(kind, recordings, first, wall, size, no_op, added, again(own))


def kept(folder: Path) -> list[Measured]:
    """Return what was measured in a folder, by kind and size."""
    found = []
    for path in folder.glob("*.json"):
        told = json.loads(path.read_text())
        both = {name: Again(**told.pop(name)) for name in ("added", "changed")}
        found.append(Measured(**told, **both))
    return sorted(found, key=lambda m: (m.kind, m.recordings))


def by_rule(measured: Sequence[Measured]) -> str:
    """Return the table of the rules that take most: CPU a recording at each size."""
    frame = pd.DataFrame(
        {
            f"{m.recordings:,}": m.jobs.groupby("rule")["cpu_s"].sum() / m.recordings
            for m in measured
        }
    )
    top = frame.sort_values(frame.columns[-1], ascending=False).head(SHOWN)
    lines = ["| rule | " + " | ".join(top) + " |", "|---" * (1 + len(top.columns)) + "|"]
    for rule, values in top.iterrows():
        lines.append(f"| {rule} | " + " | ".join(f"{v:.3f}" for v in values) + " |")
    return "\n".join(lines)


def draw(measured: Sequence[Measured], path: Path) -> None:
    """Draw CPU a recording, the longest and the largest job against recordings."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "growth"
    import matplotlib.pyplot as plt

    panels = {
        "CPU a recording (s)": lambda m: m.cpu_s,
        "longest job (CPU s)": lambda m: m.jobs["cpu_s"].max(),
        "largest job (MB)": lambda m: m.jobs["peak_mb"].max(),
    }
    figure, axes = plt.subplots(1, len(panels), figsize=(9, 3.1), layout="constrained")
    sizes = sorted({m.recordings for m in measured})
    for ax, (title, value) in zip(axes, panels.items(), strict=True):
        for (kind, name), marker in zip(KINDS.items(), "os", strict=True):
            own = [m for m in measured if m.kind == kind]
            ax.plot(
                [m.recordings for m in own], [value(m) for m in own], marker, ls="-", label=name
            )
        ax.set(xscale="log", xlabel="recordings", title=title)
        ax.set_xticks(sizes, [f"{size:,}" for size in sizes])
        ax.minorticks_off()
    for ax, limit in zip(axes[1:], (60, 1073.7), strict=True):
        ax.axhline(limit, color="0.5", ls=":", lw=1, label="a minute, 1 GiB")
    for ax in axes:
        ax.set_ylim(bottom=0)
    handles, labels = axes[1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    figure.savefig(path, metadata={"Date": None})


def write(folder: Path) -> None:
    """Fill the tables of docs/performance.md and draw the figure."""
    measured = kept(folder)
    places = {}
    for kind in KINDS:
        own = [m for m in measured if m.kind == kind]
        if own:
            places[f"growth-{kind}"] = "\n".join([HEAD, *(m.row for m in own)])
            places[f"again-{kind}"] = "\n".join([AGAIN, *(m.row_again for m in own)])
            places[f"rules-{kind}"] = by_rule(own)
    fill(PAGE, places)
    draw(measured, FIGURE)


def main() -> None:
    """Measure sizes, print the tables, and write the page where asked."""
    words = [word for word in sys.argv[1:] if word != "--write"]
    folder, kind, sizes = Path(words[0]).resolve(), words[1], [int(n) for n in words[2:]]
    print(HEAD, flush=True)
    for size in sizes:
        found = measure(folder, kind, size)
        (folder / f"{kind}-{size}.json").write_text(json.dumps(asdict(found), indent=1))
        print(found.row, flush=True)
    own = [m for m in kept(folder) if m.kind == kind]
    print("\n".join(["", AGAIN, *(m.row_again for m in own), "", by_rule(own)]))
    if "--write" in sys.argv:
        write(folder)


if __name__ == "__main__":
    main()
