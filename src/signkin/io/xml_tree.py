"""XML as elements that know their line and their bytes, so that a file can be changed in places.

Read with expat, which follows no link. Entities that a file declares are refused: a few lines
of them can grow to gigabytes, or name other files.
"""

from __future__ import annotations

import codecs
import xml.parsers.expat
from collections.abc import Iterator
from dataclasses import dataclass

from signkin.errors import SignkinError


class Element:
    """An element of a document.

    attributes, text (all character data right inside it), children; line: from 1.
    start, end: its first byte and the one after its last. inner_end: the byte at which its
    closing tag starts, None for `<A/>`.
    """

    __slots__ = ("attributes", "children", "end", "inner_end", "line", "start", "tag", "text")

    def __init__(self, tag: str, attributes: dict[str, str], line: int, start: int) -> None:
        self.tag = tag
        self.attributes = attributes
        self.text = ""
        self.children: list[Element] = []
        self.line = line
        self.start = start
        self.end = start
        self.inner_end: int | None = None

    def get(self, name: str) -> str | None:
        """Return an attribute, None where it is missing."""
        return self.attributes.get(name)

    def need(self, name: str) -> str:
        """Return an attribute; a missing one is an error with the line."""
        value = self.attributes.get(name)
        if value is None:
            raise SignkinError(
                f"{self.tag} has no {name}", place=f"line {self.line}", expected="the attribute"
            )
        return value

    def all(self, *tags: str) -> list[Element]:
        """Return the children of these tags."""
        return [child for child in self.children if child.tag in tags]

    def walk(self) -> Iterator[Element]:
        """Yield the element and everything inside it."""
        stack = [self]
        while stack:
            element = stack.pop()
            yield element
            stack += reversed(element.children)


@dataclass(frozen=True)
class Document:
    """A parsed file: its root, its bytes and the encoding they are in."""

    root: Element
    content: bytes
    encoding: str

    def encoded(self, markup: str) -> bytes:
        """Return markup as bytes of the file; a letter its encoding lacks becomes `&#220;`."""
        return markup.encode(self.encoding, "xmlcharrefreplace")


def parse(content: bytes, expected: str, *, places: bool = False) -> Document:
    """Parse the bytes of an XML file.

    expected: what the file should be, for the error. places: whether `end` and `inner_end` of
    elements are wanted, which takes time in large files.
    """
    encoding = _by_mark(content)
    builder = _Builder(None)
    try:
        try:
            builder.parser.Parse(content, True)
        except (xml.parsers.expat.ExpatError, ValueError, LookupError):
            # `encoding="utf8"` is no name of XML, and what scripts write.
            told = builder.declared or "utf-8"
            if told.lower() == "utf-8" or _known(told, "") != "utf-8":
                raise
            builder = _Builder("utf-8")
            builder.parser.Parse(content, True)
    except xml.parsers.expat.ExpatError as error:
        raise SignkinError(
            f"not well-formed XML ({xml.parsers.expat.ErrorString(error.code)})",
            place=f"line {error.lineno}, column {error.offset + 1}",
            expected=expected,
        ) from error
    except (ValueError, LookupError, UnicodeError) as error:
        raise SignkinError(
            f"the encoding {builder.declared or 'of the file'} is not one that can be read",
            place="line 1",
            expected="UTF-8, as ELAN writes it",
            todo="Open and save it in ELAN.",
        ) from error
    assert builder.root is not None  # a document without a root is not well-formed
    document = Document(builder.root, content, encoding or _known(builder.declared))
    if places:
        _set_ends(document)
    return document


def _known(declared: str | None, otherwise: str = "utf-8") -> str:
    try:
        name = codecs.lookup(declared or "utf-8").name
    except (LookupError, ValueError):
        return otherwise
    return "utf-8" if name.startswith("utf-16") else name  # without a mark it is not UTF-16


def _by_mark(content: bytes) -> str | None:
    """Return the encoding that the first bytes tell: a mark, or `<` in two bytes."""
    for mark, name in (
        (codecs.BOM_UTF8, "utf-8"),
        (codecs.BOM_UTF16_LE, "utf-16-le"),
        (codecs.BOM_UTF16_BE, "utf-16-be"),
        (b"<\0", "utf-16-le"),
        (b"\0<", "utf-16-be"),
    ):
        if content.startswith(mark):
            return name
    return None


class _Builder:
    """A parser whose handlers build the tree; encoding: instead of the one that is declared."""

    def __init__(self, encoding: str | None) -> None:
        parser = xml.parsers.expat.ParserCreate(encoding)
        parser.buffer_text = True
        self.parser = parser
        self.root: Element | None = None
        self.declared: str | None = None
        self._open: list[Element] = []
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._data
        parser.XmlDeclHandler = self._declaration
        parser.EntityDeclHandler = self._entity
        parser.SkippedEntityHandler = self._skipped

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        parser = self.parser
        element = Element(tag, attributes, parser.CurrentLineNumber, parser.CurrentByteIndex)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def _end(self, tag: str) -> None:
        # The parser stands at `</A>`, or right behind `<A/>`; `_set_ends` tells which.
        self._open.pop().end = self.parser.CurrentByteIndex

    def _data(self, text: str) -> None:
        if self._open:
            self._open[-1].text += text

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        self.declared = encoding

    def _entity(self, name: str, *rest: object) -> None:
        raise self._refused(name)

    def _skipped(self, name: str, is_parameter: bool) -> None:
        raise self._refused(name)

    def _refused(self, name: str) -> SignkinError:
        return SignkinError(
            f"the file declares or uses an entity ({name[:40]})",
            place=f"line {self.parser.CurrentLineNumber}",
            expected="XML without entities of its own, as ELAN writes it",
        )


def _set_ends(document: Document) -> None:
    content = document.content
    width = 2 if document.encoding.startswith("utf-16") else 1
    closing, bracket = (text.encode(document.encoding) for text in ("</", ">"))
    for element in document.root.walk():
        place = element.end
        # `<A/>` may stand right before another element's `</B>`: an empty tag ends in `/>`.
        name = closing + element.tag.encode(document.encoding, "replace")
        if content.startswith(name, place) and not _is_empty_tag(element, content, width):
            element.inner_end = place
            end = content.find(bracket, place)
            while end >= 0 and (end - place) % width:
                end = content.find(bracket, end + 1)
            element.end = end + width


def _is_empty_tag(element: Element, content: bytes, width: int) -> bool:
    """Whether `<A/>` ends where `element.end` stands (`<A></A>` has its `</A>` there)."""
    if element.children or element.text or element.end - element.start < 3 * width:
        return False
    before = content[element.end - 2 * width : element.end].replace(b"\0", b"")
    return before == b"/>"
