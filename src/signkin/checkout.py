"""The checkout of the repository that this package runs from, if it does.

An installed wheel is the library alone: the workflow, the corpora and the papers lie in the
repository.
"""

from __future__ import annotations

from pathlib import Path

from signkin.errors import SignkinError

_ABOVE = Path(__file__).resolve().parents[2]


def checkout() -> Path | None:
    """Return the checkout's folder; None for an installed wheel."""
    return _ABOVE if _is_one(_ABOVE) else None


def workflow_home() -> Path:
    """Return the folder with the Snakefile: the checkout, else the current folder.

    Raises SignkinError where neither is one.
    """
    home = checkout()
    if home is None and _is_one(Path.cwd()):
        home = Path.cwd()
    if home is None:
        raise SignkinError(
            "the workflow is not part of the installed package",
            file=Path.cwd(),
            expected="a checkout of signkin's repository: Snakefile, workflow/, profiles/",
            todo="Call this in a checkout, or with make there.",
        )
    return home


def _is_one(folder: Path) -> bool:
    return (folder / "Snakefile").is_file() and (folder / "workflow" / "rules").is_dir()
