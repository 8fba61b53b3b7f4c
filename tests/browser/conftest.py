"""A headless Chromium of the machine, and the pages of a run."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from support.browsing import open_page

ARGUMENTS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
WAIT_MS = 150_000  # on a machine with a load of 10


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    found = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), None)
    if found is None:
        pytest.skip("no Chromium on this machine (.ci/chromium installs Debian's)")
    with sync_playwright() as playwright:
        instance = playwright.chromium.launch(executable_path=found, args=ARGUMENTS)
        opened = instance.new_page

        def new_page(**settings: object) -> Page:
            page = opened(**settings)
            page.set_default_timeout(WAIT_MS)
            return page

        instance.new_page = new_page  # every test of the browser has the same patience
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
