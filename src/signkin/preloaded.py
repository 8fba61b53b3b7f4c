"""What jobs import, imported: the state in which the fork server (forked.py) forks them.

The modules that the scripts of workflow/ name, and those libraries that modules import where they
need them. What cannot be imported is left to the job that wants it, which tells of it.
"""

from __future__ import annotations

import re
from contextlib import suppress
from importlib import import_module

from signkin.checkout import workflow_home

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
_IMPORT = re.compile(r"^ +from (signkin[\w.]*) import", re.MULTILINE)


def names() -> list[str]:
    """Return the names of the modules, libraries first."""
    scripts = sorted((workflow_home() / "workflow" / "scripts").rglob("*.py"))
    found = {name for path in scripts for name in _IMPORT.findall(path.read_text("utf-8"))}
    return [*LIBRARIES, *sorted(found)]


for name in names():
    with suppress(Exception):
        import_module(name)
