"""The page of a single paper (`signkin audit PAPER`) in headless Chromium."""

import pytest

from signkin.__main__ import main

CLAIMS = """paper: Somebody 2024
study: mine
claims:
  - id: A
    location: Table 1
    claim: Means of whole numbers.
    needs: the paper's own data
    corpora: {missing: it is about the paper's own data}
    published:
      checks:
        - {check: grim, table: t.csv, grain: "1", reads: "Whole points."}
        - {check: p_value, kind: t, statistic: "1.74", df: ["24"], p: ".047", reads: "t and p."}
  - id: B
    location: Table 2
    claim: A table that cannot be used.
    needs: the paper's own data
    corpora: {missing: it is about the paper's own data}
    published:
      checks:
        - {check: grim, table: none.csv, grain: "1", reads: "Whole points."}
"""


@pytest.fixture(scope="module")
def paper_page(browser, tmp_path_factory):
    folder = tmp_path_factory.mktemp("a-folder-with-a-long-name") / "paper"
    folder.mkdir()
    (folder / "claims.yaml").write_text(CLAIMS, encoding="utf-8")
    (folder / "t.csv").write_text("g,n,mean\na,28,5.19\nb,30,4.90\n", encoding="utf-8")
    assert main(["audit", str(folder), "--to", str(folder / "page")]) == 1
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.trouble = []
    page.on("console", lambda m: page.trouble.append(m.text))
    page.file = folder / "page/index.html"
    page.goto(page.file.as_uri())
    yield page
    page.close()


def test_it_tells_verdicts_contradictions_and_faults(paper_page):
    assert paper_page.trouble == []
    cells = paper_page.locator("#verdicts td").all_inner_texts()
    assert "inconsistent" in [cell.strip() for cell in cells]
    assert "5.178571" in paper_page.locator("#contradictions").inner_text()
    assert "none.csv" in paper_page.locator("#faults").inner_text()
    assert "if read as two-tailed" in paper_page.locator("#claims").inner_text()


def test_it_is_no_wider_than_the_window(paper_page):
    for width in (1280, 390):
        paper_page.set_viewport_size({"width": width, "height": 800})
        assert paper_page.evaluate("document.documentElement.scrollWidth") <= width


def test_its_links_lead_to_files(paper_page):
    hrefs = paper_page.locator("main a").evaluate_all("a => a.map(e => e.getAttribute('href'))")
    for href in {h for h in hrefs if not h.startswith("#") and "docs/" not in h}:
        assert (paper_page.file.parent / href).resolve().is_file(), href
