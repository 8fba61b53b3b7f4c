"""The wheel: what is in it, and that it works in an empty environment, far from the checkout."""

import ast
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

import signkin
from signkin import SignkinError, checkout, lock

BUILD = "import sys; from setuptools import build_meta; build_meta.build_wheel(sys.argv[1])"


def called(*command, cwd):
    """Run a command that knows nothing of this checkout.

    The kernels run with the JIT off: compiling them takes half a minute, and is tested elsewhere.
    """
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "SIGNKIN"))}
    return subprocess.run(
        [str(part) for part in command], cwd=cwd, text=True, check=False,
        env={**kept, "NUMBA_DISABLE_JIT": "1"},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def checked(*command, cwd):
    done = called(*command, cwd=cwd)
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def wheel(root, tmp_path_factory):
    """Built from a copy: setuptools leaves a build folder in what it builds."""
    folder = tmp_path_factory.mktemp("build")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(root / name, folder)
    ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
    shutil.copytree(root / "src", folder / "src", ignore=ignored)
    checked(sys.executable, "-c", BUILD, folder / "dist", cwd=folder)
    (built,) = (folder / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """An environment with the wheel alone; what it depends on comes from the one of this test.

    Returns its Python and an empty folder to call it in.
    """
    folder = tmp_path_factory.mktemp("installed")
    home = folder / "environment"
    checked(sys.executable, "-m", "venv", "--without-pip", home, cwd=folder)
    scripts = home / ("Scripts" if os.name == "nt" else "bin")
    python = scripts / Path(sys.executable).name
    # A path in a .pth file adds modules, but not that folder's own .pth files: not the checkout.
    tell = "import sysconfig; print(sysconfig.get_path('purelib'))"
    purelib = Path(checked(python, "-c", tell, cwd=folder).strip())
    (purelib / "dependencies.pth").write_text(sysconfig.get_path("purelib"))
    pip = (sys._base_executable, "-m", "pip", "--python", python, "--disable-pip-version-check")
    checked(*pip, "install", "--quiet", "--no-deps", "--no-index", wheel, cwd=folder)
    (folder / "elsewhere").mkdir()
    return SimpleNamespace(python=python, command=scripts / "signkin", folder=folder / "elsewhere")


def test_the_wheel_holds_the_package_and_its_data_and_nothing_else(wheel, root):
    with zipfile.ZipFile(wheel) as archive:
        found = {name for name in archive.namelist() if ".dist-info/" not in name}
    home = root / "src"
    there = {
        path.relative_to(home).as_posix()
        for package in ("signkin", "snakemake_logger_plugin_signkin")
        for path in (home / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert found == there
    assert {"signkin/py.typed", "signkin/schemas/claims.schema.yaml"} <= found


def test_the_library_alone_does_not_ask_for_what_runs_the_workflow(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (n for n in archive.namelist() if n.endswith(".dist-info/METADATA"))
        metadata = archive.read(name).decode()
    wanted = re.findall(r"^Requires-Dist: (.*)$", metadata, re.MULTILINE)
    plain = " ".join(line for line in wanted if "extra ==" not in line)
    assert "numpy" in plain
    assert not re.search("snakemake|pytest|mkdocs|ruff|mypy", plain)
    workflow = [line for line in wanted if line.startswith("snakemake>")]
    assert workflow
    assert all("extra == 'workflow'" in line.replace('"', "'") for line in workflow)


def test_an_installed_wheel_is_not_the_checkout(installed, root):
    tell = "import signkin; print(signkin.__file__, signkin.__version__)"
    file, version = checked(installed.python, "-c", tell, cwd=installed.folder).split()
    assert not Path(file).is_relative_to(root)
    assert version == signkin.__version__


def test_the_readmes_library_example_runs_from_the_wheel(installed, root):
    (example,) = re.findall(
        r"```python\n(.*?)```", (root / "README.md").read_text(encoding="utf-8"), re.DOTALL
    )
    for name in ("take.bvh", "take.eaf"):
        shutil.copy(root / "examples" / "data" / name, installed.folder)
    end = "\nprint(take.rate_hz, path.shape, moved.shape, len(found.order_probability))\n"
    told = checked(installed.python, "-c", example + end, cwd=installed.folder)
    assert told.split() == ["50.0", "(269,", "3)", "(6,", "2)", "8"]


def test_the_audit_runs_from_the_wheel(installed, root):
    paper = shutil.copytree(root / "papers" / "naert2017", installed.folder / "paper")
    done = called(installed.command, "audit", paper, "--out", "claims.csv", cwd=installed.folder)
    told = done.stdout
    assert done.returncode == 1, done.stdout  # N18 is a contradiction
    assert re.search(r"^N18 +inconsistent", told, re.MULTILINE)
    claims = yaml.safe_load((paper / "claims.yaml").read_text(encoding="utf-8"))["claims"]
    rows = (installed.folder / "claims.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) >= 1 + len(claims)


@pytest.mark.parametrize("words", [["run"], ["utterance", "lsf-sim", "A B"]])
def test_a_command_that_wants_the_workflow_says_where_it_is(installed, words):
    done = called(installed.command, *words, cwd=installed.folder)
    assert done.returncode == 1
    assert "the workflow is not part of the installed package" in done.stdout
    assert "Traceback" not in done.stdout


def test_a_checkout_is_found_by_its_snakefile(root, tmp_path, monkeypatch):
    assert checkout.checkout() == root
    monkeypatch.setattr(checkout, "_ABOVE", tmp_path)
    assert checkout.checkout() is None
    monkeypatch.chdir(root)
    assert checkout.workflow_home() == root
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SignkinError, match="not part of the installed package"):
        checkout.workflow_home()


def test_without_snakemake_a_run_names_the_extra(root, tmp_path, monkeypatch, capsys):
    from signkin import __main__ as command

    monkeypatch.setattr(command, "find_spec", lambda name: None)
    assert command.run_workflow([], tmp_path) == 1
    assert "signkin[workflow]" in capsys.readouterr().err
    assert not (tmp_path / ".snakemake").exists()


def test_one_version_number(root):
    citation = yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == signkin.__version__
    heads = re.findall(
        r"^## (\S+)", (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert signkin.__version__ == next(head for head in heads if head != "Unreleased")


def test_a_lock_is_held_once(tmp_path):
    path = tmp_path / "lock"
    with lock.held(path) as first:
        assert first
        with lock.held(path) as second:
            assert not second
    with lock.held(path) as again:
        assert again


def test_a_lock_on_windows_is_that_of_msvcrt(tmp_path, monkeypatch):
    taken = set()

    def locking(descriptor, mode, size):
        assert (mode, size) == ("LK_NBLCK", 1)
        place = os.fstat(descriptor).st_ino
        if place in taken:
            raise PermissionError(13, "Permission denied")
        taken.add(place)

    monkeypatch.setitem(sys.modules, "fcntl", None)  # importing it fails, as on Windows
    fake = SimpleNamespace(locking=locking, LK_NBLCK="LK_NBLCK")
    monkeypatch.setitem(sys.modules, "msvcrt", fake)
    monkeypatch.setattr(sys, "platform", "win32")
    space = {"__name__": "signkin.lock"}
    exec(compile(Path(lock.__file__).read_text(encoding="utf-8"), lock.__file__, "exec"), space)
    with space["held"](tmp_path / "lock") as first, space["held"](tmp_path / "lock") as second:
        assert first is not None
        assert second is None


POSIX_ONLY = {"fcntl", "resource", "pwd", "grp", "termios", "posix", "syslog", "pty", "tty"}


def test_modules_that_windows_has_not_are_imported_where_it_is_asked_for(root):
    """These files look at `sys.platform` first."""
    found = []
    for path in (root / "src").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            found += [(path.name, n) for n in names if n.split(".")[0] in POSIX_ONLY]
    assert sorted(found) == [
        ("cost.py", "resource"),
        ("lock.py", "fcntl"),
        ("memory.py", "resource"),
    ]
