"""Run the benchmarks: `make bench`, or `python -m benchmarks [--sizes ...] [--out FOLDER]`.

The methods take turns on each trajectory, in an order that rotates, so that what else the
machine does falls on all of them alike. One thread each, and the process's own time counts, not
the clock on the wall: on a busy machine, that measures the others. The first run, with imports
and compilation, is timed apart, by the wall.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import platform
import subprocess
import sys
import time
import warnings
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

for variable in ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402

from benchmarks import cubic_cost  # noqa: E402
from benchmarks.methods import METHODS, Method  # noqa: E402
from benchmarks.trajectories import BIN_S, NOISE_SD, Trajectory, score, simulate  # noqa: E402
from signkin.binning.compiled import forget_stale_kernels  # noqa: E402

SEED = 20131107
# T, segments, trajectories.
SIZES = {100: (3, 50), 1000: (15, 7), 5000: (75, 5)}
LONG_S = 6.0  # a method that takes longer is timed on one trajectory
DRAWS = 2000
LEAST_RUNS = 5  # for an interval
REFERENCE = {
    100: "signkin, M <= 20",
    1000: "signkin, M <= 20",
    5000: "signkin, segments <= 200 bins",
}
PACKAGES = ("signkin", "numba", "numpy", "scipy", "ruptures", "ruptures-rs", "skchange",
            "bayesian-changepoint", "torch", "Rbeast")  # fmt: skip


def timed(method: Method, data: Trajectory) -> tuple[float, float, np.ndarray]:
    """Return the process's and the wall's seconds, and the boundaries, of one run in silence."""
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wall, own = time.perf_counter(), time.process_time()
        found = method.run(data.x, len(data.boundaries_s))
        return time.process_time() - own, time.perf_counter() - wall, found


def measure(
    bins: int, repeats: int | None
) -> tuple[list[dict[str, object]], list[dict[str, object]]]:
    """Return a row for each run and one for each method's first run at a size."""
    segments, number = SIZES[bins]
    number = repeats or number
    rng = np.random.default_rng([SEED, bins])
    warm, *data = [simulate(rng, bins, segments) for _ in range(number + 1)]
    methods = [m for m in METHODS if bins in m.sizes and m.there]
    firsts, runs = [], []
    long = set()
    for method in methods:
        _, first_s, _ = timed(method, warm)
        if timed(method, warm)[0] >= LONG_S:
            long.add(method.name)
        firsts.append({"bins": bins, "method": method.name, "first_s": first_s})
    for i, truth in enumerate(data):
        turn = i % len(methods)
        for method in methods[turn:] + methods[:turn]:
            if method.name in long and i > 0:
                continue
            seconds, wall, found = timed(method, truth)
            hits, false = score(found, truth)
            runs.append({
                "bins": bins, "trajectory": i, "method": method.name, "told": method.told,
                "run_s": seconds, "wall_s": wall, "true_boundaries": segments - 1, "hits": hits,
                "false_positives": false, "duration_s": bins * BIN_S,
            })  # fmt: skip
        print(f"T = {bins}: {i + 1} of {number} trajectories", file=sys.stderr)
    return runs, firsts


def summarise(runs: pd.DataFrame, firsts: pd.DataFrame) -> pd.DataFrame:
    """Return one row a method and size: times, ratio to ours with an interval, hits."""
    rows = []
    for (bins, name), part in runs.groupby(["bins", "method"], sort=False):
        reference = runs[(runs["bins"] == bins) & (runs["method"] == REFERENCE[bins])]
        shared = part.merge(reference, on="trajectory", suffixes=("", "_ours"))
        theirs, ours = shared["run_s"].to_numpy(), shared["run_s_ours"].to_numpy()
        rng = np.random.default_rng([SEED, int(bins), 1])
        draws = rng.integers(0, len(theirs), (DRAWS, len(theirs)))
        ratios = np.median(theirs[draws], axis=1) / np.median(ours[draws], axis=1)
        enough = len(theirs) >= LEAST_RUNS
        low, high = np.quantile(ratios, [0.025, 0.975]) if enough else (np.nan, np.nan)
        first = firsts[(firsts["bins"] == bins) & (firsts["method"] == name)].iloc[0]
        rows.append({
            "bins": bins, "method": name, "told": part["told"].iloc[0], "runs": len(part),
            "min_s": part["run_s"].min(), "median_s": part["run_s"].median(),
            "max_s": part["run_s"].max(), "ratio": np.median(theirs) / np.median(ours),
            "ratio_low": low, "ratio_high": high, "first_s": first["first_s"],
            "hit_rate": part["hits"].sum() / part["true_boundaries"].sum(),
            "false_per_s": part["false_positives"].sum() / part["duration_s"].sum(),
        })  # fmt: skip
    table = pd.DataFrame(rows)
    return table.sort_values(["bins", "median_s"], kind="stable").reset_index(drop=True)


def memory() -> pd.DataFrame:
    """Return the peak memory of our longest runs, each in a process of its own."""
    rows = []
    for bins, longest in ((100, 0), (1000, 0), (1000, 200), (5000, 200)):
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.memory",
             *(str(number) for number in (bins, SIZES[bins][0], longest))],
            check=True, capture_output=True, text=True,
        )  # fmt: skip
        before, peak = (float(word) for word in done.stdout.split())
        rows.append({
            "bins": bins, "max_segment_bins": longest or bins, "before_mb": before, "peak_mb": peak,
        })  # fmt: skip
    return pd.DataFrame(rows)


def milliseconds(seconds: float) -> str:
    """Return a time with three digits."""
    return f"{seconds * 1e3:,.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def interval(low: float, high: float) -> str:
    """Return (low - high), or what stands for too few runs."""
    return "(-)" if np.isnan(low) else f"({low:.3g} - {high:.3g})"


def markdown(table: pd.DataFrame, peaks: pd.DataFrame, missing: list[str]) -> str:
    """Return the tables as text for people."""
    lines = [machine(), ""]
    for bins, part in table.groupby("bins"):
        lines += [
            f"T = {bins:,} ({SIZES[bins][0]} segments); ratios to `{REFERENCE[bins]}`", "",
            "| method | told | median | min - max | ratio (95 %) | hits | false pos./s | runs |",
            "|---|---|---|---|---|---|---|---|",
        ]  # fmt: skip
        for row in part.itertuples():
            lines.append(
                f"| {row.method} | {row.told} | {milliseconds(row.median_s)} "
                f"| {milliseconds(row.min_s)} - {milliseconds(row.max_s)} "
                f"| {row.ratio:.3g} {interval(row.ratio_low, row.ratio_high)} "
                f"| {row.hit_rate:.2f} | {row.false_per_s:.2f} | {row.runs} |"
            )
        lines.append("")
    lines += ["| T | longest segment | before | peak |", "|---|---|---|---|"]
    lines += [
        f"| {r.bins:,} | {r.max_segment_bins:,} | {r.before_mb:.0f} MB | {r.peak_mb:.0f} MB |"
        for r in peaks.itertuples()
    ]
    first = table[table["method"].str.startswith("signkin")]["first_s"].max()
    lines += ["", f"First run of ours, with imports and compilation or its cache: {first:.2f} s."]
    if missing:
        lines += ["", f"Left out, because not installed: {', '.join(missing)}."]
    return "\n".join(lines) + "\n"


def machine() -> str:
    """Return what was measured on, and with which versions."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        model = names[0].split(":", 1)[1].strip() if names else model
    found = []
    for package in PACKAGES:
        with contextlib.suppress(PackageNotFoundError):
            found.append(f"{package} {version(package)}")
    cores = os.cpu_count()
    return f"{model}, {cores} cores, Python {platform.python_version()}; {', '.join(found)}."


def main() -> None:
    """Measure, and write runs.csv, summary.csv, memory.csv and summary.md."""
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks"))
    parser.add_argument("--sizes", type=int, nargs="+", default=list(SIZES), choices=list(SIZES))
    parser.add_argument("--repeats", type=int, help="trajectories a size, instead of 50, 7 and 5")
    options = parser.parse_args()
    forget_stale_kernels()
    rng = np.random.default_rng(SEED)
    differs = cubic_cost.check(simulate(rng, 100, 3).x, NOISE_SD)
    if differs > 1e-6:
        sys.exit(f"the costs given to ruptures differ from least squares by {differs:.1e}")
    runs, firsts = [], []
    for bins in options.sizes:
        more, first = measure(bins, options.repeats)
        runs += more
        firsts += first
    table = summarise(pd.DataFrame(runs), pd.DataFrame(firsts))
    peaks = memory()
    missing = [m.name for m in METHODS if not m.there]
    options.out.mkdir(parents=True, exist_ok=True)
    pd.DataFrame(runs).to_csv(options.out / "runs.csv", index=False)
    table.to_csv(options.out / "summary.csv", index=False)
    peaks.to_csv(options.out / "memory.csv", index=False)
    text = markdown(table, peaks, missing)
    (options.out / "summary.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
