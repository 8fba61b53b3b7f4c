"""The site, the examples, and the places of docs/ that programs fill."""

import importlib
import re
import subprocess
import sys

import pytest

from tools import examples, marked


@pytest.fixture(scope="module")
def site(root, tmp_path_factory):
    """The site, built with every warning an error."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    done = subprocess.run(
        [*command, str(root / "docs"), str(folder / "html")], cwd=folder, text=True, check=False,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    return folder / "html"


def test_every_page_of_docs_is_in_the_site(site, root):
    index = (site / "index.html").read_text(encoding="utf-8")
    for page in (root / "docs").glob("*.md"):
        assert (site / f"{page.stem}.html").is_file()
        assert page.stem == "index" or f'href="{page.stem}.html"' in index


def test_what_a_package_exports_stands_on_the_page_of_the_api(site, root, monkeypatch):
    monkeypatch.syspath_prepend(root / "docs")
    promised = importlib.import_module("conf").packages()
    assert {"signkin", "signkin.binning", "signkin.audit"} <= set(promised)
    page = (site / "api.html").read_text(encoding="utf-8")
    for package, names in promised.items():
        for name in names:
            home = getattr(importlib.import_module(package), name)
            assert f'id="{package}.{name}"' in page or isinstance(home, tuple | str | dict), name


def test_the_site_asks_the_network_for_nothing(site):
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        loaded = re.findall(r"<(?:script|img|iframe)[^>]*src=\"([^\"]*)\"", text)
        loaded += re.findall(r"<link[^>]*href=\"([^\"]*)\"", text)
        assert [address for address in loaded if "//" in address] == []


def test_the_page_of_examples_has_them_all(root):
    found = marked.names((root / "docs" / "examples.md").read_text(encoding="utf-8"))
    assert sorted(found) == examples.names()


@pytest.mark.parametrize("name", examples.names())
def test_an_example_prints_what_the_page_says(root, name):
    told = marked.content((root / "docs" / "examples.md").read_text(encoding="utf-8"), name)
    assert told == examples.block(name), "run: python -m tools.examples"


TEXT = "a\n<!-- begin:x -->\nold\n<!-- end:x -->\nb\n<!-- begin:y -->\n<!-- end:y -->\n"


def test_a_marked_place_is_filled_and_nothing_else_changes(tmp_path):
    page = tmp_path / "p.md"
    page.write_text(TEXT)
    assert marked.fill(page, {"x": "new\\1\nnew", "y": "z"})
    assert page.read_text() == TEXT.replace("old\n", "new\\1\nnew\n").replace(
        "begin:y -->\n", "begin:y -->\nz\n"
    )
    assert not marked.fill(page, {"y": "z"})
    with pytest.raises(marked.MarkError, match="no place"):
        marked.fill(page, {"w": ""})


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (TEXT + TEXT, "twice: x, x, y, y"),
        (TEXT.replace("<!-- end:x -->\n", ""), "begin:y stands inside x"),
        (TEXT.replace("<!-- begin:x -->\n", ""), "end:x stands inside None"),
        (TEXT.removesuffix("<!-- end:y -->\n"), "begin:y has no end"),
    ],
)
def test_a_broken_mark_is_told(text, told):
    with pytest.raises(marked.MarkError, match=told):
        marked.names(text)
