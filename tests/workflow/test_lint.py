"""`snakemake --lint`, with the one finding that this project answers otherwise."""

import re
import subprocess
import sys

# One environment for all rules, pinned in requirements.lock and made by `make`: neither conda
# nor a container. Snakemake's linter wants one of the two named on each rule.
ANSWERED = "Specify a conda environment or container for each rule."


def test_the_workflow_is_lint_clean(root):
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", "--snakefile", root / "Snakefile", "--lint"],
        cwd=root, capture_output=True, text=True, check=False,
    )  # fmt: skip
    titles = re.findall(r"^    \* (.+):$", done.stdout + done.stderr, flags=re.MULTILINE)
    assert set(titles) == {ANSWERED}, done.stdout
