"""Jobs as forks: what the process they are forked from has imported, and how they end."""

import sys

import pytest

from signkin import preloaded
from signkin.forked import FORKS, run_forked

pytestmark = pytest.mark.skipif(not FORKS, reason="jobs are forked on Linux alone")

SCRIPT = """
import os, sys
from pathlib import Path
print("out of", __name__, file=sys.stderr)
here = Path({folder!r})
imported = "matplotlib.pyplot" in sys.modules and "signkin.stages.ingest" in sys.modules
(here / "told").write_text(f"{{Path.cwd() == here}} {{sys.argv}} {{imported}}")
fresh = sys.modules.setdefault("mark", sys) is sys and not hasattr(os, "marked")
os.marked = True
{end}
"""


@pytest.fixture
def script(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def write(end):
        path = tmp_path / "it's a [script] & more.py"
        path.write_text(SCRIPT.format(folder=str(tmp_path), end=end))
        return path

    return write


def test_it_is_what_the_scripts_of_the_workflow_import():
    names = set(preloaded.names())
    wanted = {"pandas", "signkin.stages.ingest", "signkin.pages.overview", "signkin.pages.site"}
    assert wanted <= names
    assert wanted <= sys.modules.keys()


def test_a_script_runs_where_everything_is_imported_and_its_end_is_told(script, tmp_path):
    path = script("")
    assert run_forked(path) == 0
    assert (tmp_path / "told").read_text() == f"True {[str(path)]} True"
    assert run_forked(script("sys.exit(3)")) == 3
    assert run_forked(script("raise ValueError('x')")) == 1
    assert run_forked(script("os.kill(os.getpid(), 9)")) == -9
    assert run_forked(script("sys.exit(0 if fresh else 4)")) == 0  # of no other script's state
