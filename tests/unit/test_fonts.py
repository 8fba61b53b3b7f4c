"""Fonts in PDFs: cut down beforehand, or read as a whole, the bytes are the same."""

from io import BytesIO

import matplotlib.pyplot as plt
import pytest
from matplotlib.backends import _backend_pdf_ps

from signkin.figures import fonts
from signkin.figures.fonts import cut_fonts
from signkin.figures.style import paper_style

WHOLE = fonts.whole_fonts


@pytest.mark.parametrize("text", ["Hit rate (%), efficient – β = −1/3 é ≤ 0.5", "Жест"])
def test_a_cut_font_gives_the_same_bytes(text, monkeypatch):
    read = []

    def whole(font, glyphs):
        read.append(font)
        return WHOLE(font, glyphs)

    monkeypatch.setattr(fonts, "whole_fonts", whole)
    with paper_style():
        figure, ax = plt.subplots(figsize=(2, 1))
        ax.set_title(text)
        plain, cut = BytesIO(), BytesIO()
        figure.savefig(plain, format="pdf", metadata={"CreationDate": None})
        read.clear()
        with cut_fonts():
            figure.savefig(cut, format="pdf", metadata={"CreationDate": None})
        plt.close(figure)
    assert plain.getvalue() == cut.getvalue()
    # What no cut holds is looked for in the whole font.
    assert isinstance(read[-1], BytesIO) is ("Ж" not in text)
    assert _backend_pdf_ps.get_glyphs_subset is WHOLE
