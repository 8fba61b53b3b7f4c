"""The audit's page in headless Chromium."""

import pytest


@pytest.fixture
def audit_page(browser, report):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.trouble = []
    page.on("console", lambda m: page.trouble.append(m.text))
    page.file = report.parents[1] / "audit/index.html"
    page.goto(page.file.as_uri())
    yield page
    page.close()


def test_every_claim_stands_with_its_verdict(audit_page):
    assert audit_page.trouble == []
    labels = audit_page.locator("h3 .label").all_inner_texts()
    wanted = [f"N{i:02d}" for i in range(1, 24)] + [f"E{i:02d}" for i in range(1, 14)]
    assert set(wanted) <= set(labels)
    row = audit_page.locator("#verdicts tr", has_text="N18").first.locator("td").all_inner_texts()
    assert row[3].strip() == "inconsistent"
    cells = audit_page.locator("td").all_text_contents()
    assert [c for c in cells if c.strip() in ("", "None", "nan", "inf")] == []


def test_its_links_lead_to_files(audit_page):
    hrefs = audit_page.locator("main a").evaluate_all("a => a.map(e => e.getAttribute('href'))")
    files = {href for href in hrefs if not href.startswith("#") and "docs/" not in href}
    assert len(files) > 15
    for href in files:
        assert (audit_page.file.parent / href).resolve().is_file(), href


def test_it_is_no_wider_than_the_window(audit_page):
    for width in (1280, 390):
        audit_page.set_viewport_size({"width": width, "height": 800})
        assert audit_page.evaluate("document.documentElement.scrollWidth") <= width


def test_it_tells_where_the_two_papers_agree(audit_page):
    section = audit_page.locator("#two-papers")
    assert "manual tags are hit above chance on 2 of 2 wrists" in section.inner_text()
    assert section.locator("tbody tr").count() == 6
    claim = audit_page.locator(".exhibit", has=audit_page.locator(".label", has_text="N19")).first
    assert claim.locator("td", has_text="beside the claim").count() == 4


def test_its_figures_are_drawn(audit_page):
    audit_page.evaluate("document.querySelectorAll('main details').forEach(d => d.open = true)")
    images = audit_page.locator("img")
    assert images.count() >= 5
    for image in images.all():
        image.scroll_into_view_if_needed()
        audit_page.wait_for_function("e => e.complete", arg=image.element_handle())
        assert image.evaluate("e => e.naturalWidth") > 300


def test_the_report_links_to_it(browser, report):
    page = browser.new_page()
    page.goto(report.as_uri())
    assert page.locator("#audit a", has_text="All claims").count() == 1
    assert "N18" in page.locator("#audit").inner_text()
    page.close()
