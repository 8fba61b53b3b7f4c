"""Fonts in PDFs: cut down once to what figures write, and for each figure from that.

A PDF holds of each font the glyphs that its text needs (`pdf.fonttype: 42`). To find them fontTools
reads the whole font, 6,000 glyphs and their substitutions, again for every file. A cut that holds
some 400 glyphs gives the same bytes in a fraction of the time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from typing import Any

from matplotlib.backends import _backend_pdf_ps

# ASCII, Latin-1, Greek, dashes and quotes, raised and lowered digits, arrows, operators, ligatures.
WRITTEN = (
    (0x20, 0x7E), (0xA0, 0xFF), (0x391, 0x3C9), (0x2010, 0x2026), (0x2030, 0x2033),
    (0x2070, 0x208E), (0x2190, 0x2193), (0x2200, 0x2265), (0xFB00, 0xFB04),
)  # fmt: skip

whole_fonts: Any = _backend_pdf_ps.get_glyphs_subset


class _Cut(BytesIO):
    """A font in memory, as matplotlib asks for it."""

    face_index = 0


@contextmanager
def cut_fonts() -> Iterator[None]:
    """Take fonts of PDFs from their cuts, inside."""
    before = _backend_pdf_ps.get_glyphs_subset
    _backend_pdf_ps.get_glyphs_subset = _smaller
    try:
        yield
    finally:
        _backend_pdf_ps.get_glyphs_subset = before


def _smaller(font: Any, glyphs: Iterable[int]) -> Any:
    wanted = set(glyphs)
    places, data = _cut(font) if font.face_index == 0 else ({}, b"")
    if not wanted <= places.keys():
        return whole_fonts(font, wanted)
    return _placed(whole_fonts(_Cut(data), {places[glyph] for glyph in wanted}), places)


@contextmanager
def _placed(found: Any, places: Mapping[int, int]) -> Iterator[Any]:
    """Give what was found in a cut for the places in the whole font, by which it is asked."""
    whole = {place: glyph for glyph, place in places.items()}
    with found as result:
        given = {whole[place]: new for place, new in result.glyph_index_map.items()}
        yield result._replace(glyph_index_map=given)


@cache
def _cut(font: Any) -> tuple[dict[int, int], bytes]:
    """Return a cut, a font, and the places in it of its glyphs, by their places in the font."""
    from matplotlib.ft2font import FT2Font

    wanted = {
        glyph
        for character, glyph in FT2Font(font).get_charmap().items()
        if any(first <= character <= last for first, last in WRITTEN)
    }
    with whole_fonts(font, wanted) as found:
        places = dict(found.glyph_index_map)
        return places, _backend_pdf_ps.font_as_file(found.font).getvalue()
