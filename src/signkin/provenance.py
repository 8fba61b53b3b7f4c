"""Digests of the code that a rule depends on.

Snakemake reruns a job when its script changes, but does not see the library
behind it. `code_digest` follows a script's imports through signkin and hashes
what it finds, templates included, for use as a parameter of the rule.
"""

from __future__ import annotations

import ast
import hashlib
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from signkin.checkout import checkout

PACKAGE = Path(__file__).resolve().parent


def code_digest(script: str | Path) -> str:
    """Return a digest of a script and of every signkin module that it imports, however deep."""
    script = Path(script)
    modules: set[Path] = set()
    open_files = [script]
    while open_files:
        for module in _imports(open_files.pop()):
            if module not in modules:
                modules.add(module)
                open_files.append(module)
    digest = hashlib.sha256(script.read_bytes())
    for path in sorted(_with_data_files(modules)):
        digest.update(path.relative_to(PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def _imports(path: Path) -> tuple[Path, ...]:
    tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
    return tuple(module for name in _names(tree.body) for module in _files_of(name))


def _names(body: list[ast.stmt]) -> Iterator[str]:
    """Yield dotted names that statements import, at any depth, but not for type checking only."""
    for statement in body:
        if isinstance(statement, ast.If) and ast.unparse(statement.test).endswith("TYPE_CHECKING"):
            continue
        for node in _statements(statement):
            if isinstance(node, ast.Import):
                yield from (alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                yield node.module
                yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _statements(outer: ast.AST) -> Iterator[ast.AST]:
    """Yield a statement and those inside it, but no expressions, which are most of a tree."""
    yield outer
    for field in ("body", "orelse", "finalbody", "handlers", "cases"):
        inner = getattr(outer, field, ())
        for one in inner if isinstance(inner, list) else ():  # a lambda's body is no list
            yield from _statements(one)


@cache
def _files_of(name: str) -> tuple[Path, ...]:
    """Return the files that importing a dotted name runs: each package on the way, the module."""
    parts = name.split(".")
    if parts[0] != PACKAGE.name:
        return ()
    found = []
    for depth in range(1, len(parts) + 1):
        base = PACKAGE.joinpath(*parts[1:depth])
        for path in (base / "__init__.py", base.with_suffix(".py")):
            if path.is_file():
                found.append(path)
                break
    return tuple(found)


def _with_data_files(modules: set[Path]) -> set[Path]:
    """Add the files that are not Python below each subpackage (templates).

    Not those of caches: what numba compiles lies in one from the first run on.
    """
    packages = {m.parent for m in modules if m.name == "__init__.py" and m.parent != PACKAGE}
    return modules.union(*(_data_files(package) for package in packages))


@cache
def _data_files(package: Path) -> tuple[Path, ...]:
    files = (p for p in package.rglob("*") if p.suffix != ".py" and "__pycache__" not in p.parts)
    return tuple(p for p in files if p.is_file())


def commit() -> str:
    """Return the commit of the checkout; '' where there is none, or no git."""
    folder = checkout()
    if folder is None:
        return ""
    try:
        found = subprocess.run(
            ["git", "-C", str(folder), "rev-parse", "HEAD"], capture_output=True, text=True,
            check=False, timeout=20,
        )  # fmt: skip
    except OSError:  # no git on this machine
        return ""
    return found.stdout.strip() if found.returncode == 0 else ""
