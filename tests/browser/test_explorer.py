"""The page of a recording in headless Chromium: hover, playback, keys, addresses, weight."""

import pytest

from signkin.explorer.pages import write_pages
from support.explorer_pages import HOSTILE, made_up, signer

SIGNS = [(0.5, 1.0, "CAT"), (1.4, 2.0, HOSTILE), (2.5, 3.0, "DOG"), (3.6, 4.2, "L" * 200)]
MOST_BYTES = 5_000_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Pages of takes that are hard to draw, and of one that is not."""
    folder = tmp_path_factory.mktemp("recordings")
    holed = signer("holed", 3.0, seed=2)
    holed.positions[40:70, 5] = float("nan")
    riddled = signer("riddled", 3.0, seed=3)
    riddled.positions[:, 10] = float("nan")
    for name, takes, signs in (
        ("tagged", [signer()], SIGNS),
        ("untagged", [holed, riddled], ()),
        ("flat", [signer("flat", 3.0, unit="px", flat=True)], ()),
    ):
        sources = made_up(folder / "made" / name, takes, signs, binned=name == "tagged")
        write_pages(sources, folder / name, folder / f"{name}.html")
    return folder


@pytest.fixture
def opened(browser, folder):
    """Return a function that opens a page; every message, error and request of it is trouble."""
    pages = []

    def opened(name, fragment="", **window):
        window = {"viewport": {"width": 1280, "height": 900}, **window}
        page = browser.new_page(**window)
        pages.append(page)
        page.trouble = []
        page.on("console", lambda m: page.trouble.append(m.text))
        page.on("pageerror", lambda e: page.trouble.append(str(e)))
        file = folder / f"{name}.html"
        page.on(
            "request",
            lambda r: (
                None if r.url.startswith(("data:", file.as_uri())) else page.trouble.append(r.url)
            ),
        )
        page.goto(file.as_uri() + fragment)
        page.wait_for_selector("body[data-ready=yes]")
        settled(page)
        return page

    yield opened
    for page in pages:
        assert page.trouble == []
        page.close()


def settled(page):
    """Wait until what was asked for is drawn."""
    page.evaluate("() => new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))")


def time_of(page):
    return float(page.get_attribute("body", "data-time"))


def view_of(page):
    return [float(page.get_attribute("body", f"data-{end}")) for end in ("from", "to")]


def drawn(page, canvas):
    """Return a canvas as it is, and the share of its pixels that are not empty."""
    return page.evaluate(
        """id => { const c = document.getElementById(id);
            const copy = new OffscreenCanvas(c.width, c.height)
                .getContext("2d", { willReadFrequently: true });
            copy.drawImage(c, 0, 0);
            const d = copy.getImageData(0, 0, c.width, c.height).data;
            let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0;
            return [c.toDataURL(), n / (d.length / 4)]; }""",
        canvas,
    )


def press(page, key):
    page.keyboard.press(key)
    settled(page)


def test_hover_shows_values_and_a_click_goes_there(opened):
    page = opened("tagged/one")
    before, _ = drawn(page, "body")
    plot = page.locator(".u-over").first
    box = plot.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 40)
    settled(page)
    told = page.inner_text("#readout")
    assert told.startswith("3.0") and "right " in told and "m/s" in told
    page.mouse.move(box["x"] + box["width"] * 0.7 / 6, box["y"] + 40)
    settled(page)
    assert "sign CAT" in page.inner_text("#readout")
    assert time_of(page) == 0
    page.mouse.down()
    page.mouse.up()
    settled(page)
    assert time_of(page) == pytest.approx(0.7, abs=0.03)
    assert drawn(page, "body")[0] != before


def test_playback_moves_the_skeleton_and_stops_at_the_end(opened):
    page = opened("tagged/one", "#t=1")
    first, share = drawn(page, "body")
    assert share > 0.01
    page.select_option("#pace", "0.25")
    press(page, " ")
    page.wait_for_function("() => Number(document.body.dataset.time) > 1.1")
    assert page.inner_text("#play") == "Pause"
    assert drawn(page, "body")[0] != first
    press(page, "End")
    assert page.inner_text("#play") == "Play"
    press(page, "ArrowLeft")
    press(page, " ")
    page.wait_for_function("() => Number(document.body.dataset.time) > 5.999")
    page.wait_for_function("() => document.getElementById('play').textContent === 'Play'")


def test_keys_go_to_tags_flags_and_transitions_and_zoom(opened):
    page = opened("tagged/one")
    for wanted in (0.5, 1.0, 1.4):
        press(page, "n")
        assert time_of(page) == pytest.approx(wanted, abs=1e-3)
    assert f"start of {HOSTILE[:20]}" in page.inner_text("#said")
    press(page, "p")
    assert time_of(page) == pytest.approx(1.0, abs=1e-3)
    press(page, "f")
    assert time_of(page) == pytest.approx(1.4, abs=1e-3)  # the second sign has no minimum near
    assert "no speed minimum" in page.inner_text("#said")
    press(page, "t")
    assert time_of(page) == pytest.approx(2.0, abs=1e-3)
    a, b = view_of(page)
    press(page, "+")
    c, d = view_of(page)
    assert d - c == pytest.approx((b - a) / 2, abs=0.01)
    press(page, "0")
    assert view_of(page) == pytest.approx([0, 6])
    press(page, "ArrowRight")
    assert time_of(page) == pytest.approx(2.02, abs=1e-3)


def test_an_address_with_a_time_opens_there(opened):
    page = opened("tagged/one", "#t=2.5")
    assert time_of(page) == pytest.approx(2.5)
    assert page.evaluate("location.hash") == "#t=2.5"
    page.evaluate("location.hash = '#t=1.0'")
    page.wait_for_function("() => document.body.dataset.time === '1.0000'")
    assert "Transition 1: CAT" in page.inner_text("#pair-title")
    opened("tagged/one", "#t=99999")
    opened("tagged/one", "#t=nonsense")


def test_wheel_zooms_where_the_pointer_is_and_dragging_moves_along(opened):
    page = opened("tagged/one")
    box = page.locator(".u-over").first.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 30)
    page.mouse.wheel(0, -400)
    page.wait_for_function("() => Number(document.body.dataset.from) > 0")
    a, b = view_of(page)
    assert (a + b) / 2 == pytest.approx(3, abs=0.02) and b - a < 3
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 4, box["y"] + 30, steps=4)
    page.mouse.up()
    settled(page)
    c, d = view_of(page)
    assert c - a == pytest.approx((b - a) / 4, abs=0.02) and d - c == pytest.approx(b - a, abs=0.01)
    assert time_of(page) == 0  # a drag is no click


def test_captured_and_synthesised_stand_side_by_side(opened):
    page = opened("tagged/one", "#t=1.0")
    assert page.is_visible("#captured") and page.is_visible("#made")
    captured, _ = drawn(page, "captured")
    page.fill("#pair-time", "0.15")
    settled(page)
    halfway, share = drawn(page, "made")
    assert share > 0.01 and drawn(page, "captured")[0] != captured
    page.select_option("#pair-method", "interpolation")
    settled(page)
    assert drawn(page, "made")[0] != halfway
    page.click("#pair-play")
    assert page.inner_text("#pair-play") == "Pause both"


def test_the_skeleton_turns_by_keys_and_buttons_where_it_has_depth(opened):
    page = opened("tagged/one")
    front, _ = drawn(page, "body")
    page.focus("#body")
    press(page, "ArrowLeft")
    assert drawn(page, "body")[0] != front and time_of(page) == 0
    page.click("[data-view=front]")
    settled(page)
    assert drawn(page, "body")[0] == front
    assert opened("flat/flat").locator("[data-view]").count() == 0


def test_what_is_missing_is_told_and_the_page_still_plays(opened):
    for name, told in (
        ("untagged/holed", "No tags"),
        ("untagged/riddled", "No speed"),
        ("flat/flat", "Flat (2-D)"),
    ):
        page = opened(name)
        assert told in page.inner_text(".missing")
        first, share = drawn(page, "body")
        assert share > 0.005
        press(page, "End")
        assert time_of(page) == pytest.approx(3.0)
        assert drawn(page, "body")[0] != first
    page = opened("untagged/holed")
    press(page, "f")
    assert "no position for" in page.inner_text("#said")


def test_orders_are_chosen_and_the_density_of_each_is_drawn_and_read(opened):
    page = opened("tagged/one")
    named = "Posterior of boundaries over time, by order: {} wrist"
    panels = [page.locator(f'.panel[data-panel="{named.format(h)}"]') for h in ("right", "left")]
    assert [panel.count() for panel in panels] == [1, 1]
    chips = page.locator("#orders .chip")
    pressed = "[...document.querySelectorAll('#orders .chip')].map(c => c.ariaPressed)"
    assert chips.count() == 8
    assert page.evaluate(pressed) == ["false"] * 3 + ["true"] + ["false"] * 4  # that of the tables
    picture = "p => p.querySelector('canvas').toDataURL()"
    before = panels[0].evaluate(picture)
    chips.nth(0).click()
    settled(page)
    assert panels[0].evaluate(picture) != before
    plot = panels[1].locator(".u-over").bounding_box()
    page.mouse.move(plot["x"] + plot["width"] / 2, plot["y"] + 20)
    settled(page)
    told = page.inner_text("#readout")
    for hand in ("right", "left"):
        assert f"P(boundary), {hand}, order 0: " in told
        assert f"P(boundary), {hand}, order 3: " in told
    assert "order 7" not in told


def test_html_in_a_gloss_is_text(opened):
    page = opened("tagged/one")
    assert page.title().startswith("one")
    assert HOSTILE[:10] in page.inner_text("#transitions")
    assert page.locator("#transitions script").count() == 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_it_fits_the_window_and_every_plot_is_drawn(opened, width, scheme):
    window = {"viewport": {"width": width, "height": 844}, "color_scheme": scheme}
    page = opened("tagged/one", **window)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    sizes = page.locator(".uplot canvas").evaluate_all("c => c.map(e => [e.width, e.height])")
    assert len(sizes) == 6  # two speeds, two densities of boundaries, tags, the axis of time
    assert all(across > 300 and high > 20 for across, high in sizes)
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(20, 24, 27)"
    assert dark == (scheme == "dark")
    assert (
        page.locator("button:visible").evaluate_all(
            "all => all.filter(b => !(b.textContent.trim() || b.ariaLabel)).length"
        )
        == 0
    )


def test_pages_of_a_run_are_light_and_whole(simulated_run, browser):
    folder = simulated_run.results / "report/recordings"
    for name, panels in (("lsf-sim/lsf-sim-1", 6), ("isl-sim", 0)):
        file = folder / f"{name}.html"
        assert file.stat().st_size < MOST_BYTES
        page = browser.new_page()
        trouble = []
        page.on("console", lambda m, to=trouble: to.append(m.text))
        page.on("pageerror", lambda e, to=trouble: to.append(str(e)))
        page.goto(file.as_uri())
        if panels:
            page.wait_for_selector("body[data-ready=yes]")
        assert page.locator(".uplot").count() == panels
        links = page.locator("a").evaluate_all("a => a.map(e => e.getAttribute('href'))")
        for href in (h for h in links if not h.startswith("#")):
            assert (file.parent / href).resolve().is_file(), href
        assert trouble == []
        page.close()
