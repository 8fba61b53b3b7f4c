"""Pages opened in a browser that may ask nobody for anything."""


def open_page(browser, file, **options):
    """Open a page; what it asks of the network, or complains of, is kept in `trouble`."""
    page = browser.new_page(**{"viewport": {"width": 1280, "height": 900}, **options})
    page.trouble = []
    page.on("console", lambda m: page.trouble.append(m.text))
    page.on("pageerror", lambda e: page.trouble.append(str(e)))
    page.on(
        "request",
        lambda r: (
            None if r.url.startswith(("file:", "data:", "blob:")) else page.trouble.append(r.url)
        ),
    )
    page.goto(file.as_uri())
    return page
