"""The report as a reader meets it, in headless Chromium."""

import pytest


@pytest.fixture
def page(browser, report):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.trouble = []
    page.on("console", lambda m: page.trouble.append(m.text))
    page.on("pageerror", lambda e: page.trouble.append(str(e)))
    page.on(
        "request",
        lambda r: None if r.url.startswith(("file:", "data:")) else page.trouble.append(r.url),
    )
    page.goto(report.as_uri())
    yield page
    page.close()


def test_the_page_is_whole_and_asks_nobody(page):
    assert page.trouble == []
    assert page.title().startswith("Sign-language motion")
    text = page.locator("main").inner_text()
    assert "Naert, Larboulette & Gibet 2017" in text
    assert "Endres, Meirovitch, Flash & Giese 2013" in text


def test_it_stays_light(report):
    assert report.stat().st_size < 4e6  # some 40 figures at less than a tenth of a megabyte


def test_every_figure_is_drawn_and_described(page):
    images = page.locator("img")
    assert images.count() >= 10
    for image in images.all():
        natural, shown = image.evaluate("e => [e.naturalWidth, e.clientWidth]")
        assert natural > 300
        assert 300 < shown <= natural + 1
        assert len(image.get_attribute("alt")) > 40


def test_every_exhibit_of_the_paper_is_there_and_linked(page):
    labels = page.locator("#lsf-sim h3 .label").all_inner_texts()
    assert labels == [
        "Figure 1", "Figure 2", "Table 1", "Figure 4", "Figure 5", "Figure 6", "Figure 7",
        "Figure 8", "Figure 9", "Table 2", "Figure 10", "Figure 11", "Figure 12", "Figure 13",
    ]  # fmt: skip
    assert page.locator("#overview h3 .label").all_inner_texts() == ["Figure 3"]
    for link in page.locator("nav a").all():
        assert page.locator(link.get_attribute("href")).count() == 1, link.inner_text()


def test_links_lead_to_files(page, report):
    hrefs = page.locator(".files a").evaluate_all("a => a.map(e => e.getAttribute('href'))")
    assert len(hrefs) > 20
    for href in hrefs:
        assert (report.parent / href).resolve().is_file(), href


def test_no_number_is_missing_without_a_dash(page):
    cells = page.locator("td:not(.note)").all_text_contents()  # those folded away too
    assert len(cells) > 200
    assert [c for c in cells if c.strip() in ("", "None", "nan", "inf")] == []


def test_the_text_and_the_table_tell_the_same_number(page):
    row = page.locator("#summary tr", has_text="lsf-sim").locator("td").all_inner_texts()
    table = page.locator("#lsf-sim .exhibit", has=page.locator(".label", has_text="Table 2"))
    last = table.locator("tr", has_text="all").last.locator("td").all_inner_texts()
    assert "89" in row
    assert last[1].startswith("89")
    assert last[2].startswith("0.303")
    assert "0.303" in row


def test_nothing_is_wider_than_the_window(page):
    for width in (1280, 700, 390):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
