"""The same bits on every processor: vectors of two numbers, of four, of eight."""

import os
import subprocess
import sys
from pathlib import Path

import llvmlite.binding as llvm

from support import bits


def test_the_plainest_processor_finds_the_same_bits(root):
    """The code for it is kept in build/: compiling it takes longer than all else here."""
    plain = {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(root / "build" / "plain-kernels"),
    }
    done = subprocess.run(
        [sys.executable, bits.__file__],
        env={**os.environ, **plain},
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == bits.digest(), f"here: {llvm.get_host_cpu_name()}"
