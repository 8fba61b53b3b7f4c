"""Figures in a page: as files beside it, or as addresses that hold the whole drawing."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path

from markupsafe import Markup

_PLACES = re.compile(r'(?<= )(d|x|y)="([^"]*)"')
_LONG = re.compile(r"-?\d+\.\d{3,}")
_SIZE = re.compile(r'<svg[^>]*?\bviewBox="[-\d.]+ [-\d.]+ ([\d.]+) ([\d.]+)"')


@dataclass
class Images:
    """The folder of a site's figures; each is written once, under a name of its own.

    root: the results, which hold them.
    """

    folder: Path
    root: Path
    _names: dict[Path, str] = field(default_factory=dict)

    def address(self, svg: Path, home: Path) -> str:
        """Return a figure's address as seen from the page's folder; writes it on the way."""
        name = self._names.get(svg)
        if name is None:
            name = "-".join(Path(os.path.relpath(svg, self.root)).parts)
            self._names[svg] = name
            self.folder.mkdir(parents=True, exist_ok=True)
            content = lighter(svg.read_text(encoding="utf-8"))
            (self.folder / name).write_text(content, encoding="utf-8")
        return Path(os.path.relpath(self.folder / name, home)).as_posix()


class InPlace:
    """Figures that lie near the page already, and are shown from there."""

    def address(self, svg: Path, home: Path) -> str:
        """Return a figure's address as seen from the page's folder."""
        return Path(os.path.relpath(svg, home)).as_posix()


def size_of(svg: Path) -> tuple[int, int] | None:
    """Return width and height of a drawing, so that a page keeps its place; None if not told."""
    found = _SIZE.search(svg.read_text(encoding="utf-8")[:2000])
    return (round(float(found[1]) * 4 / 3), round(float(found[2]) * 4 / 3)) if found else None


def data_uri(svg: Path) -> Markup:
    """Return an SVG file as a data address, so that identifiers of figures cannot clash."""
    content = lighter(Path(svg).read_text(encoding="utf-8"))
    for sign in '%#"&\n':  # the only ones that an address between double quotes cannot hold
        content = content.replace(sign, f"%{ord(sign):02X}")
    return Markup(f"data:image/svg+xml,{content}")


def lighter(svg: str) -> str:
    """Return an SVG with places to a hundredth of its unit, a point as matplotlib writes it.

    The page holds all figures; their files keep every digit.
    """

    def rounded(number: re.Match[str]) -> str:
        return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")

    def shorter(found: re.Match[str]) -> str:
        places = _LONG.sub(rounded, " ".join(found[2].split()))
        return f"{found[1]}='{places}'"

    body = svg[max(svg.find("<svg"), 0) :]  # an image in a page needs no prologue
    body = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    body = re.sub(r">\s+<", "><", _PLACES.sub(shorter, body).strip())
    # Single quotes stay as they are in the page, double ones would take three letters each.
    return body if re.search(r'="[^"\']*\'', body) else body.replace('"', "'")
