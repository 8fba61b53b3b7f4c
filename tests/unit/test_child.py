"""Nothing outlives the command, and the lock stays while the child lives."""

import os
import signal
import subprocess
import sys
import time

import pytest

from signkin import SignkinError
from signkin.__main__ import refuse_unquotable
from signkin.lock import held

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals and locks of POSIX")

PARENT = """
import sys
from pathlib import Path
from signkin.child import run_child
from signkin.lock import held
with held(Path(sys.argv[1])) as lock:
    code = "import pathlib, sys, time; pathlib.Path(sys.argv[1]).touch(); time.sleep(120)"
    status = run_child([sys.executable, "-c", code, sys.argv[2]], Path("."), {}, lock)
sys.exit(0 if status < 0 else 9)
"""


def until(condition, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False


def free(path):
    with held(path) as lock:
        return lock is not None


@pytest.fixture
def running(tmp_path):
    lock, started = tmp_path / "lock", tmp_path / "started"
    process = subprocess.Popen([sys.executable, "-c", PARENT, str(lock), str(started)])
    assert until(started.exists)
    yield process, lock
    if process.poll() is None:
        process.kill()
    process.wait()


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_signals_to_the_command_alone_end_the_child(running, name):
    process, lock = running
    assert not free(lock)
    os.kill(process.pid, getattr(signal, name))
    assert process.wait(60) == 0
    assert free(lock)


def test_a_killed_command_leaves_no_child_and_no_lock(running):
    process, lock = running
    process.kill()
    process.wait(60)
    if sys.platform == "linux":
        assert until(lambda: free(lock))


def test_the_child_holds_the_lock(tmp_path):
    lock = tmp_path / "lock"
    with held(lock) as mine:
        child = subprocess.Popen(
            [sys.executable, "-c", "import time; time.sleep(120)"], pass_fds=(mine,)
        )
    try:
        assert not free(lock)
    finally:
        child.kill()
        child.wait()
    assert free(lock)


@pytest.mark.parametrize("folder", ["my signs", "a&b", "x[1]", "it's"])
def test_a_python_that_a_shell_takes_apart_is_refused(folder):
    with pytest.raises(SignkinError, match="the path of Python holds"):
        refuse_unquotable(f"/home/me/{folder}/.venv/bin/python")
    refuse_unquotable("/home/me/signs-2.0_a/.venv/bin/python3.11")
