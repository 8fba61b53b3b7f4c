"""A headless Chromium of the machine, and the pages of a run."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, sync_playwright

from support.browsing import open_page

ARGUMENTS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    found = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), None)
    if found is None:
        pytest.skip("no Chromium on this machine (.ci/chromium installs Debian's)")
    with sync_playwright() as playwright:
        instance = playwright.chromium.launch(executable_path=found, args=ARGUMENTS)
        yield instance
        instance.close()


@pytest.fixture(scope="session")
def report(simulated_run):
    return simulated_run.results / "report/index.html"


@pytest.fixture(scope="session")
def home(report):
    """Folder of the report's pages."""
    return report.parent


@pytest.fixture
def opened(browser):
    """A function that opens the file of a page, closed after the test."""
    pages = []

    def go(file, **options):
        pages.append(open_page(browser, file, **options))
        return pages[-1]

    yield go
    for page in pages:
        page.close()
