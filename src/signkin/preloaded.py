"""What jobs import, imported: the state in which the fork server (forked.py) forks them.

The modules that the scripts of workflow/ name, and those libraries that modules import where they
need them. What cannot be imported is left to the job that wants it, which tells of it.
"""

from __future__ import annotations

import ast
import gc
from contextlib import suppress
from importlib import import_module
from io import BytesIO

from signkin.checkout import workflow_home

# Objects made between two searches for cycles, of which jobs make few; Python's own number is 700.
BETWEEN_COLLECTIONS = 20_000

LIBRARIES = (
    "snakemake.script",
    "matplotlib.pyplot",
    "matplotlib.backends.backend_pdf",
    "matplotlib.backends.backend_svg",
    "numpy.random",
    "pandas",
    "pyarrow.parquet",
    "scipy.optimize",
    "scipy.signal",
    "scipy.spatial.transform",
    "scipy.special",
    "scipy.stats",
    "seaborn",
)


def names() -> list[str]:
    """Return the names of the modules, libraries first; of scripts, all that could be one."""
    found: set[str] = set()
    for path in sorted((workflow_home() / "workflow" / "scripts").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("signkin"):
                found |= {f"{node.module}.{alias.name}" for alias in node.names}
                found.add(str(node.module))
    return [*LIBRARIES, *sorted(found)]


def _draw() -> None:
    """Draw a figure as jobs do: fonts, formulas and what writes SVG and PDF are read by then."""
    from matplotlib import pyplot as plt

    from signkin.figures.fonts import cut_fonts
    from signkin.figures.style import paper_style

    with paper_style(), cut_fonts():
        figure, ax = plt.subplots()
        ax.set_title(r"$\beta = -\frac{1}{3}$ –")
        ax.set_xlabel("bold", weight="bold")
        for kind in ("svg", "pdf"):
            figure.savefig(BytesIO(), format=kind)
        plt.close(figure)


for name in names():
    with suppress(Exception):  # `signkin.tables.read_table` is no module
        import_module(name)
with suppress(Exception):
    _draw()

# A million objects are there by now, and stay: no job looks through them for garbage again, nor
# writes into their pages, which the forks share.
gc.collect()
gc.freeze()
gc.set_threshold(BETWEEN_COLLECTIONS, 20, 100)
