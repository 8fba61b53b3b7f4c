"""The site of docs/ (make docs): every page of this folder, and the API from the docstrings."""

import ast
import importlib
import sys
from pathlib import Path

from pygments.lexers.special import TextLexer

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "src" / "signkin"
sys.path.insert(0, str(PACKAGE.parent))

project = "signkin"
author = "The signkin authors"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = "signkin"
html_copy_source = False
html_show_sphinx = False
default_role = "code"  # what stands between single backticks in a docstring
smartquotes = False
myst_heading_anchors = 4
nitpicky = False  # types of numpy and pandas have no page here
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_type_aliases = {"ArrayLike": "ArrayLike"}

AUTOMODULE = """
```{{eval-rst}}
.. automodule:: {name}
   :members: {members}
   :imported-members:
```
"""


def exported(package: str) -> list[str]:
    """Return a package's `__all__`, without modules; none where it has no such list."""
    folder = PACKAGE.parent.joinpath(*package.split("."))
    tree = ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            names: list[str] = ast.literal_eval(node.value)
            return [name for name in names if not (folder / f"{name}.py").is_file()]
    return []


def packages() -> dict[str, list[str]]:
    """Return the packages that say what others may rely on, the top first, and those names."""
    below = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
    there = ["signkin", *(f"signkin.{name}" for name in below)]
    return {name: names for name in there if (names := exported(name))}


def with_api(app: object, page: str, source: list[str]) -> None:
    """Put the packages on the page api.md."""
    if page == "api":
        for name, names in packages().items():
            module = importlib.import_module(name)
            for member in names:  # autodoc does not see what is imported on first use
                setattr(module, member, getattr(module, member))
            source[0] += f"\n## {name}\n" + AUTOMODULE.format(name=name, members=", ".join(names))


def setup(app: object) -> None:
    """Called by Sphinx."""
    app.connect("source-read", with_api)  # type: ignore[attr-defined]
    # Drawn where the page is read on the web; drawing it here would want a script from elsewhere.
    # csv and expect: files and what is expected of the walk-through, which a test runs.
    for plain in ("mermaid", "csv", "expect"):
        app.add_lexer(plain, TextLexer)  # type: ignore[attr-defined]
