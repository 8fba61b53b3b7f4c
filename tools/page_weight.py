"""`python -m tools.page_weight RESULTS`: how heavy the report's pages are, and how soon they show.

Opens each page of a finished run in headless Chromium, as from disk, and writes the table in
benchmarks/README.md: the heaviest and the slowest of each kind. First paint is the browser's own
`first-contentful-paint`, the soonest of five visits.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

from tools.marked import fill

ROOT = Path(__file__).resolve().parents[1]
PAGE, PLACE = ROOT / "benchmarks" / "README.md", "pages"
KINDS = {
    "front page": "report/index.html",
    "a corpus": "report/corpora/*.html",
    "a paper": "report/papers/*.html",
    "methods, provenance": "report/[mp]*.html",
    "audit": "audit/index.html",
    "list of recordings": "report/recordings/*.html",
    "a recording (explorer)": "report/recordings/*/*.html",
}
MOST_OF_A_KIND = 3  # the heaviest
VISITS = 5
MOST_BYTES = {"a recording (explorer)": 5e6}
OTHER_BYTES = 3e6
MOST_MS = 1000.0


def first_paint_ms(browser: Browser, file: Path) -> float:
    """Return when a page first shows something, the soonest of five visits."""
    times = []
    for _ in range(VISITS):
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.set_default_timeout(120_000)
        page.goto(file.as_uri())
        times.append(
            page.evaluate(
                """() => new Promise(done => new PerformanceObserver(list => {
                    const one = list.getEntriesByName("first-contentful-paint")[0];
                    if (one) done(one.startTime);
                }).observe({ type: "paint", buffered: true }))"""
            )
        )
        page.close()
    return float(min(times))  # what else the machine does only adds


def measured(results: Path) -> tuple[str, list[str]]:
    """Return the table, and what is heavier or slower than promised."""
    found = shutil.which("chromium") or shutil.which("google-chrome")
    lines = ["| page | how many | heaviest | slowest first paint |", "|---|---|---|---|"]
    beyond = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=found, args=["--no-sandbox", "--disable-gpu"]
        )
        for kind, pattern in KINDS.items():
            files = sorted(results.glob(pattern), key=lambda f: -f.stat().st_size)
            if not files:
                continue
            times = {file: first_paint_ms(browser, file) for file in files[:MOST_OF_A_KIND]}
            heaviest, slowest = files[0], max(times, key=lambda file: times[file])
            size = heaviest.stat().st_size
            lines.append(
                f"| {kind} | {len(files)} | {size / 1e6:.2f} MB ({heaviest.stem}) | "
                f"{times[slowest] / 1000:.2f} s ({slowest.stem}) |"
            )
            if size > MOST_BYTES.get(kind, OTHER_BYTES):
                beyond.append(f"{heaviest}: {size:,} bytes")
            if times[slowest] > MOST_MS:
                beyond.append(f"{slowest}: first paint after {times[slowest]:.0f} ms")
        browser.close()
    return "\n".join(lines), beyond


def main(results: str) -> int:
    """Write the table; 1 where a page is heavier or slower than promised."""
    table, beyond = measured(Path(results))
    print(table, *beyond, sep="\n")
    fill(PAGE, {PLACE: table})
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
