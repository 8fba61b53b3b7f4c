"""CPU time of imports: those that users write, and those of each workflow script.

    python benchmarks/imports.py [--repeats 5] [--src FOLDER]

Each is timed in processes of its own, from the start of the import to its end, and the median
told. --src: the `src` folder of another checkout, whose `workflow/scripts` are timed with it.
"""

from __future__ import annotations

import argparse
import ast
import os
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STATEMENTS = (
    "import numpy",
    "import numba",
    "import signkin",
    "import signkin.binning",
    "from signkin.binning import Prior, fit",
    "import signkin.kinematics",
    "from signkin.kinematics import speed",
    "import signkin.powerlaw",
)
TIMER = "import time; t = time.process_time()\n{}\nprint(time.process_time() - t)"


def imports_of(script: Path) -> str:
    """Return the import statements of a script, wherever they stand, one a line."""
    nodes = ast.walk(ast.parse(script.read_text(encoding="utf-8")))
    return "\n".join(ast.unparse(n) for n in nodes if isinstance(n, (ast.Import, ast.ImportFrom)))


def cpu_s(code: str, src: Path, repeats: int) -> float:
    """Return the median CPU time of some statements; the first run, which may compile, is extra."""
    times = []
    for _ in range(repeats + 1):
        done = subprocess.run(
            [sys.executable, "-c", TIMER.format(code)],
            env={**os.environ, "PYTHONPATH": str(src)},
            capture_output=True,
            text=True,
            check=True,
        )
        times.append(float(done.stdout.split()[-1]))
    return statistics.median(times[1:])


def main() -> None:
    """Print two tables in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--src", type=Path, default=ROOT / "src")
    told = parser.parse_args()
    src = told.src.resolve()
    measured = {code: cpu_s(code, src, told.repeats) for code in STATEMENTS}
    numba = measured["import numba"]
    print("| statement | CPU | times `import numba` |\n|---|---|---|")
    for code, seconds in measured.items():
        print(f"| `{code}` | {seconds:.2f} s | {seconds / numba:.2f} |")
    scripts = src.parent / "workflow" / "scripts"
    print("\n| script | CPU of its imports |\n|---|---|")
    for script in sorted(scripts.rglob("*.py")):
        seconds = cpu_s(imports_of(script), src, told.repeats)
        print(f"| {script.relative_to(scripts)} | {seconds:.2f} s |")


if __name__ == "__main__":
    main()
