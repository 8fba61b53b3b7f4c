"""The pages of the report as a reader meets them, in headless Chromium."""

from pathlib import Path

import pytest

from support.browsing import open_page

PAGES = (
    "index", "corpora/lsf-sim", "corpora/isl-sim", "papers/naert2017", "papers/endres2013",
    "papers/one_wrist", "methods", "provenance", "../audit/index",
)  # fmt: skip
HEAVIEST = 3e6
AXE = Path(__file__).parents[1] / "vendor" / "axe-core" / "axe.min.js"


@pytest.fixture(params=PAGES, scope="module")
def page(request, browser, home):
    page = open_page(browser, home / f"{request.param}.html")
    yield page
    page.close()


def test_every_page_is_whole_light_and_asks_nobody(page):
    assert page.trouble == []
    file = Path(page.url.removeprefix("file://").partition("#")[0])
    assert file.stat().st_size < HEAVIEST
    assert page.locator("h1").count() == 1
    assert page.locator("html.ready").count() == 1
    page.evaluate("document.querySelectorAll('main details').forEach(d => d.open = true)")
    # Every figure is drawn, described and no wider than it is.
    for image in page.locator("img").all():
        image.scroll_into_view_if_needed()
        page.wait_for_function("e => e.complete", arg=image.element_handle())
        natural, shown = image.evaluate("e => [e.naturalWidth, e.clientWidth]")
        assert natural > 300
        assert 300 < shown <= natural + 1
        assert len(image.get_attribute("alt")) > 40
    cells = page.locator("td:not(.note):not(.rating)").all_text_contents()
    assert [c for c in cells if c.strip() in ("", "None", "nan", "inf")] == []
    for width in (390, 1280):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth") <= width, width


def test_links_lead_to_files_and_places(page):
    hrefs = set(page.locator("a").evaluate_all("a => a.map(e => e.getAttribute('href'))"))
    assert len(hrefs) > 8
    file = Path(page.url.removeprefix("file://").partition("#")[0])
    for href in hrefs:
        name, _, place = href.partition("#")
        if name and "docs/" not in name and "times.html" not in name:
            assert (file.parent / name).resolve().exists(), href
        elif place:
            assert page.locator(f"[id='{place}']").count() == 1, href


@pytest.mark.skipif(not AXE.is_file(), reason="axe-core is not in tests/vendor")
def test_no_page_has_a_serious_fault_for_who_cannot_see_it(page):
    page.evaluate("document.querySelectorAll('main details').forEach(d => d.open = true)")
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run().then(r => r.violations)")
    serious = [
        (v["id"], v["nodes"][0]["html"][:150])
        for v in found
        if v["impact"] in ("serious", "critical")
    ]
    assert serious == []


def test_the_front_page_says_first_what_is_missing(opened, report):
    page = opened(report)
    sections = page.locator("main section").evaluate_all("s => s.map(e => e.id)")
    assert sections[0] == "first"
    first = page.locator("#first summary").first
    assert "dgs-1984189" in first.inner_text()
    first.click()
    assert "no folder of real recordings is set" in page.locator("#first").inner_text()
    text = page.locator("main").inner_text()
    assert "Naert, Larboulette & Gibet 2017" in text
    assert "Endres, Meirovitch, Flash & Giese 2013" in text


def test_every_exhibit_of_the_paper_is_there_in_its_order(opened, home):
    page = opened(home / "papers/naert2017.html")
    labels = page.locator("main h3 .label").all_inner_texts()
    assert labels == [
        "Figure 3", "Figure 1", "Figure 2", "Table 1", "Figure 4", "Figure 5", "Figure 6",
        "Figure 7", "Figure 8", "Figure 9", "Table 2", "Figure 10", "Figure 11", "Figure 12",
        "Figure 13",
    ]  # fmt: skip


def test_text_and_tables_of_all_pages_tell_the_same_number(opened, home, report):
    row = opened(report).locator("#summary tr", has_text="lsf-sim").locator("td").all_inner_texts()
    assert "89" in row and "0.303" in row
    paper = opened(home / "papers/naert2017.html")
    table = paper.locator(".exhibit", has=paper.locator(".label", has_text="Table 2"))
    last = table.locator("tr", has_text="all").last.locator("td").all_inner_texts()
    assert last[1].startswith("89") and last[2].startswith("0.303")
    assert (
        "0.303 s on average" in opened(home / "corpora/lsf-sim.html").locator("#short").inner_text()
    )


def column(page, table, i):
    return table.locator("tbody tr").evaluate_all(
        f"rows => rows.map(r => r.cells[{i}].textContent)"
    )


def test_tables_sort_filter_and_turn_pages(opened, home):
    page = opened(home / "corpora/isl-sim.html")
    box = page.locator("#recordings .exhibit", has_text="All recordings")
    assert "1 to 25 of 80" in box.locator(".told").inner_text()
    heads = box.locator("th").all_inner_texts()
    at = next(i for i, head in enumerate(heads) if head.startswith("length"))
    button = box.locator("th button").nth(at)
    button.focus()
    page.keyboard.press("Enter")
    up = [float(c) for c in column(page, box, at)]
    assert up == sorted(up)
    assert box.locator("th").nth(at).get_attribute("aria-sort") == "ascending"
    button.click()
    down = [float(c) for c in column(page, box, at)]
    assert down == sorted(down, reverse=True) and down[0] > up[-1]
    box.get_by_role("button", name="Next").click()
    assert "26 to 50 of 80" in box.locator(".told").inner_text()
    box.get_by_role("button", name="All rows of").click()
    assert box.locator("tbody tr").count() == 80
    name = column(page, box, 0)[3].strip()
    box.get_by_role("searchbox").fill(name)
    assert column(page, box, 0)[0].strip() == name
    assert box.locator("tbody tr").count() < 5


def test_types_sort_as_text(opened, home):
    page = opened(home / "corpora/lsf-sim.html")
    box = page.locator("#durations .exhibit", has_text="By type").first
    box.locator("th button", has_text="type").first.click()
    kinds = [c.strip() for c in column(page, box, 0)]
    assert kinds == sorted(kinds) and kinds[0].startswith("00") and len(kinds[0]) == 4


def test_a_chosen_recording_or_signer_is_marked_in_tables_and_plots(opened, home):
    page = opened(home / "corpora/lsf-sim.html")
    plot = page.locator("svg.plot").last
    points = plot.locator("[data-recording='lsf-sim-1']").count()
    assert 10 < points < plot.locator("[data-recording]").count()
    page.locator("#recordings button.choose", has_text="lsf-sim-1").click()
    assert plot.locator("[data-recording].on").count() == points
    assert page.locator("#recordings tr.on").count() == 1
    assert "lsf-sim-1" in page.locator(".marked").first.inner_text()
    page.keyboard.press("Escape")
    assert page.locator(".on").count() == 0
    plot.locator("[data-recording='lsf-sim-2']").first.dispatch_event("click")
    assert page.locator("#recordings tr.on").get_attribute("data-recording") == "lsf-sim-2"
    two = opened(home / "corpora/isl-sim.html")
    two.locator("#recordings select").first.select_option(index=1)
    assert two.locator("svg.plot .on").count() == 40


def test_a_point_of_figure_7_opens_at_its_transition(opened, home):
    page = opened(home / "corpora/lsf-sim.html")
    box = page.locator(".exhibit", has=page.locator("h3", has_text="Duration and distance"))
    points = box.locator("[data-open]")
    assert points.count() == box.locator("svg [data-recording]").count() > 10
    address = points.nth(3).get_attribute("data-open")
    at = float(address.partition("#t=")[2])
    points.nth(3).dispatch_event("click")
    place = box.locator(".marked a")
    assert place.get_attribute("href") == address
    assert page.locator("#recordings tr.on").count() == 1
    place.click()
    page.wait_for_selector("body[data-ready=yes]")
    assert float(page.get_attribute("body", "data-time")) == pytest.approx(at, abs=0.01)
    assert "Transition" in page.inner_text("#pair-title")


def test_every_table_of_a_corpus_fits_a_screen(opened, home):
    page = opened(home / "corpora/lsf-sim.html")
    wide = page.locator(".scroll").evaluate_all(
        "all => all.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.dataset.title)"
    )
    assert "All recordings" not in wide
    assert "Recordings, tags and transitions that look odd" not in wide
    heads = page.locator("#recordings th").all_inner_texts()
    assert any(head.startswith("what looks odd") for head in heads)


def test_what_is_folded_opens_by_its_address_at_once_and_on_paper(opened, home):
    audit = home.parent / "audit/index.html"
    page = opened(audit)
    folds = page.locator("main details.fold")
    shut = page.locator("main details.fold:not([open])").count()
    assert 30 < shut < folds.count()
    claims = page.locator("#naert2017 > .exhibit")
    assert claims.first.locator(".label").inner_text() == "N18"  # inconsistent: first, and open
    assert claims.first.locator("details.fold").first.get_attribute("open") is not None
    assert "consistent" in claims.nth(1).locator(".brief").inner_text()
    page.locator("nav .inner", has_text="N05").first.click()
    opened_one = page.locator(".exhibit", has=page.locator(".label", has_text="N05")).first
    assert opened_one.locator("table").first.is_visible()
    page.get_by_role("button", name="Close all of Naert").click()
    assert not opened_one.locator("table").first.is_visible()
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("main details.fold:not([open])").count() == 0
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("main details.fold:not([open])").count() >= shut


def test_ratings_are_kept_and_saved_as_csv(opened, home, tmp_path):
    page = opened(home / "corpora/lsf-sim.html")
    row = page.locator("#recordings tr[data-recording='lsf-sim-2']")
    row.locator("select").select_option("exclude")
    row.locator("input").fill('left hand "jumps", see 3 s')
    row.locator("input").press("Tab")
    assert "1 rating" in page.locator(".ratings").inner_text()
    page.reload()
    row = page.locator("#recordings tr[data-recording='lsf-sim-2']")
    assert row.locator("select").input_value() == "exclude"
    with page.expect_download() as got:
        page.get_by_role("button", name="Save as CSV").click()
    saved = tmp_path / got.value.suggested_filename
    got.value.save_as(saved)
    assert saved.name == "ratings-lsf-sim.csv"
    lines = saved.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "corpus,recording,start_s,end_s,gloss,rating,note"
    assert lines[1] == 'lsf-sim,lsf-sim-2,,,,exclude,"left hand ""jumps"", see 3 s"'
    page.get_by_role("button", name="Forget all").click()
    assert "0 ratings" in page.locator(".ratings").inner_text()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_can_be_read_in_light_and_dark(opened, home, scheme):
    page = opened(home / "index.html", color_scheme=scheme)
    colours = page.evaluate(
        "() => (s => [s.color, s.backgroundColor])(getComputedStyle(document.body))"
    )
    lightness = [sum(map(int, c[4:-1].split(","))) / 3 for c in colours]
    assert abs(lightness[0] - lightness[1]) > 150
    assert (lightness[1] < 60) == (scheme == "dark")


def test_print_hides_what_only_a_screen_needs(opened, report):
    page = opened(report)
    page.emulate_media(media="print")
    assert not page.locator("nav").is_visible()
    assert page.locator("#summary table").is_visible()
    page.set_viewport_size({"width": 718, "height": 1000})  # A4 without margins
    assert page.evaluate("document.documentElement.scrollWidth") <= 718
