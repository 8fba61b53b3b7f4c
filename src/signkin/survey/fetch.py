"""Files of a corpus with a public address: fetched, gone on with after a break, and verified.

corpus.yaml names them: `downloads: {file: address}`, each with its SHA-256 under `checksums`.
"""

from __future__ import annotations

import http.client
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.request import Request, urlopen

from signkin.checksum import sha256_of
from signkin.corpus import Corpus
from signkin.errors import SignkinError

CHUNK = 1 << 20
PATIENCE_S = 60.0
PART = ".part"
AGAIN = "Call the same command again: it goes on where this one stopped."


@dataclass(frozen=True)
class Fetched:
    """A file that is there and has its checksum. bytes: how many had to be fetched."""

    path: Path
    bytes: int


def fetch(
    corpus: Corpus, folder: Path, say: Callable[[str], None] = lambda _: None
) -> list[Fetched]:
    """Fetch the files of a corpus into its data folder; those that are there are verified.

    Raises SignkinError where the corpus has no address, where a server does not answer or sends
    less than it promised, and where a file has another checksum than corpus.yaml tells.
    """
    addresses = corpus.settings.get("downloads", {})
    place = corpus.folder / "corpus.yaml"
    if not addresses:
        raise SignkinError(
            "no file with a public address",
            file=place,
            place="key downloads",
            expected="file: address, and its SHA-256 under checksums",
            todo="Get the recordings from their owners: the licence and the citation stand there.",
        )
    folder.mkdir(parents=True, exist_ok=True)
    out = []
    for name, address in addresses.items():
        target, wanted = folder / name, corpus.settings["checksums"][name]
        if target.exists():
            _verify(target, wanted, place, "Move it away to fetch it anew.")
            out.append(Fetched(target, 0))
            say(f"{target}: there, and right")
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(target.name + PART)
        say(f"{target}: from {address}")
        received = _receive(address, part)
        try:
            _verify(part, wanted, place, "Is it another version? What was fetched is deleted.")
        except SignkinError:
            part.unlink()
            raise
        part.replace(target)
        out.append(Fetched(target, received))
        say(f"{target}: {received} bytes, and right")
    return out


def _verify(path: Path, wanted: str, place: Path, todo: str) -> None:
    found = sha256_of(path)
    if found != wanted:
        raise SignkinError(
            f"its SHA-256 is {found}",
            file=path,
            expected=f"{wanted} ({place}, key checksums)",
            todo=todo,
        )


def _receive(address: str, part: Path) -> int:
    """Append what lacks of a file to `part`; return how many bytes came."""
    have = part.stat().st_size if part.exists() else 0
    request = Request(address, headers={"Range": f"bytes={have}-"} if have else {})
    try:
        with urlopen(request, timeout=PATIENCE_S) as answer:
            # A server that knows no ranges sends the file from its start.
            goes_on = answer.status == http.client.PARTIAL_CONTENT and _starts_at(answer) == have
            return _store(answer, part, have if goes_on else 0)
    except HTTPError as error:
        if error.code == http.client.REQUESTED_RANGE_NOT_SATISFIABLE and have:
            if error.headers.get("Content-Range", "").endswith(f"/{have}"):
                return 0  # all of it was there
            part.unlink()  # the rest of another version
            return _receive(address, part)
        raise SignkinError(
            f"the server answers {error.code} {error.reason}",
            file=address,
            todo="Has the corpus moved? Correct `downloads` in corpus.yaml.",
        ) from error
    except (URLError, OSError, http.client.HTTPException) as error:
        reason = getattr(error, "reason", error)
        raise SignkinError(
            f"{_size(part)} bytes came, then: {type(error).__name__}, {reason}",
            file=address,
            todo=AGAIN,
        ) from error


def _starts_at(answer: Any) -> int:
    """Return the first byte of a partial answer, -1 where it does not tell it."""
    span = str(answer.headers.get("Content-Range", "")).removeprefix("bytes ").partition("-")[0]
    return int(span) if span.isdigit() else -1


def _store(answer: Any, part: Path, offset: int) -> int:
    """Write an answer behind the first `offset` bytes of `part`."""
    promised = answer.headers.get("Content-Length")
    received = 0
    with part.open("ab" if offset else "wb") as file:
        while block := answer.read(CHUNK):
            file.write(block)
            received += len(block)
    if promised is not None and received != int(promised):
        raise SignkinError(
            f"{received} bytes came",
            file=answer.url,
            expected=f"{promised}, which the server promised",
            todo=AGAIN,
        )
    return received


def _size(part: Path) -> int:
    return part.stat().st_size if part.exists() else 0
