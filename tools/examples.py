"""Run the examples and write what they print into docs/examples.md.

python -m tools.examples
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tools.marked import fill

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = ROOT / "examples"
PAGE = ROOT / "docs" / "examples.md"


def names() -> list[str]:
    """Return the names of the examples."""
    return sorted(path.stem for path in EXAMPLES.glob("*.py"))


def block(name: str) -> str:
    """Return the code of an example and what it prints, as the page shows them.

    With the JIT off: what it compiles for half a minute takes three seconds here.
    """
    code = (EXAMPLES / f"{name}.py").read_text(encoding="utf-8")
    done = subprocess.run(
        [sys.executable, f"{name}.py"], cwd=EXAMPLES, check=True, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "NUMBA_DISABLE_JIT": "1"},
    )  # fmt: skip
    return f"```python\n{code}```\n\n```text\n{done.stdout}```\n"


def main() -> None:
    """Write the page."""
    changed = fill(PAGE, {name: block(name) for name in names()})
    print(f"{PAGE.relative_to(ROOT)}: {'written' if changed else 'as it was'}")


if __name__ == "__main__":
    main()
