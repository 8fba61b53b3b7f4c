"""`python -m tools.flow`: who imports whom, drawn from the code into docs/architecture.md."""

from __future__ import annotations

import tomllib
from pathlib import Path

import grimp

from tools.marked import fill

ROOT = Path(__file__).resolve().parents[1]
PLACE = "flow"
# Packages that are shown box by box; every other module right below signkin is a box or `base`.
OPEN = ("studies",)
PARTS = (
    "io", "kinematics", "coarticulation", "powerlaw", "binning", "simulate", "statistics",
    "figures", "report", "audit", "stages", "studies", "pages", "explorer", "corpus", "survey",
    "segments",
)  # fmt: skip


def box(module: str) -> str:
    """Return the box that a module belongs to: a part, a study, or `base` for what all share."""
    names = module.split(".")[1:]
    if not names:
        return "base"
    if names[0] in OPEN and len(names) > 1:
        return ".".join(names[:2])
    return names[0] if names[0] in PARTS else "base"


def boxes(module: str) -> set[str]:
    """Return the boxes of a module that a contract names: all studies for `signkin.studies`."""
    if module.removeprefix("signkin.") not in OPEN:
        return {box(module)}
    folder = ROOT / "src" / Path(*module.split("."))
    return {box(f"{module}.{study.name}") for study in folder.iterdir() if study.is_dir()}


def arrows() -> set[tuple[str, str]]:
    """Return (box that is imported, box that imports it) for every import in the code.

    The command lines (`__main__`) are left out: they call everything.
    """
    graph = grimp.build_graph("signkin", cache_dir=None)
    found = set()
    for importer in graph.modules:
        if importer.endswith("__main__") or box(importer) == "base":
            continue
        for imported in graph.find_modules_directly_imported_by(importer):
            pair = (box(imported), box(importer))
            if pair[0] != pair[1] and pair[0] not in ("base", *OPEN):
                found.add(pair)
    return found


def reduced(pairs: set[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the arrows without those that a longer way stands for."""

    def reachable(start: str, skip: tuple[str, str]) -> set[str]:
        seen: set[str] = set()
        stack = [start]
        while stack:
            here = stack.pop()
            for a, b in pairs:
                if a == here and (a, b) != skip and b not in seen:
                    seen.add(b)
                    stack.append(b)
        return seen

    return sorted(pair for pair in pairs if pair[1] not in reachable(pair[0], pair))


def picture(pairs: set[tuple[str, str]]) -> str:
    """Return the arrows as a Mermaid graph, which repository sites draw."""
    names = sorted({name for pair in pairs for name in pair})
    lines = ["```mermaid", "flowchart LR"]
    lines += [f'  {name.replace(".", "_")}["{name}"]' for name in names]
    lines += [f"  {a.replace('.', '_')} --> {b.replace('.', '_')}" for a, b in reduced(pairs)]
    return "\n".join([*lines, "```"])


def forbidden(pyproject: Path) -> set[tuple[str, str]]:
    """Return the arrows (imported, importer) that the contracts in pyproject.toml rule out."""
    contracts = tomllib.loads(pyproject.read_text(encoding="utf-8"))["tool"]["importlinter"]
    out = set()
    for contract in contracts["contracts"]:
        if contract["type"] == "independence":
            modules = contract["modules"]
            pairs = {(a, b) for a in modules for b in modules if a != b}
        else:
            pairs = {
                (a, b) for b in contract["source_modules"] for a in contract["forbidden_modules"]
            }
        out |= {(x, y) for a, b in pairs for x in boxes(a) for y in boxes(b)}
    return {(a, b) for a, b in out if a != b}


def main() -> None:
    """Write the picture."""
    changed = fill(ROOT / "docs" / "architecture.md", {PLACE: picture(arrows())})
    print("written" if changed else "as it was")


if __name__ == "__main__":
    main()
