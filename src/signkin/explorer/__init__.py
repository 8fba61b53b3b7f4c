"""A page a recording: speeds, tags, boundaries and a skeleton that plays in time with them.

Everything is in the page: numbers packed small (`packing.py`), the plotting library (`vendor/`),
the page's own script (`templates/`). A page asks for nothing else.
"""
