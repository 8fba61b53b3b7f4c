"""Files of corpora from a server on loopback: whole, in parts, cut off, wrong."""

import hashlib
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
import yaml

from signkin.__main__ import main
from signkin.corpus import load_corpus
from signkin.errors import SignkinError
from signkin.survey.fetch import fetch
from support.runs import MINI

CONTENT = bytes(range(256)) * 4000
SHA256 = hashlib.sha256(CONTENT).hexdigest()


class Server(ThreadingHTTPServer):
    """Serves CONTENT. asked: the Range of each request. most: bytes it sends before it hangs up."""

    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.asked, self.most, self.ranges, self.content = [], None, True, CONTENT

    @property
    def address(self):
        return f"http://127.0.0.1:{self.server_port}/m.bin"


class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        span = self.headers.get("Range") if self.server.ranges else None
        self.server.asked.append(span)
        content, first = self.server.content, 0
        if not self.path.endswith("m.bin"):
            self.send_error(404)
            return
        if span:
            first = int(span.removeprefix("bytes=").rstrip("-"))
            if first >= len(content):
                self.send_response(416)
                self.send_header("Content-Range", f"bytes */{len(content)}")
                self.end_headers()
                return
            self.send_response(206)
            end = len(content) - 1
            self.send_header("Content-Range", f"bytes {first}-{end}/{len(content)}")
        else:
            self.send_response(200)
        part = content[first:]
        self.send_header("Content-Length", str(len(part)))
        self.end_headers()
        self.wfile.write(part[: self.server.most])

    def log_message(self, *_):
        pass


@pytest.fixture
def server():
    with Server() as one:
        threading.Thread(target=one.serve_forever, args=(0.01,), daemon=True).start()
        yield one
        one.shutdown()


@pytest.fixture
def corpus(tmp_path, server):
    def make(address=None, sha256=SHA256):
        folder = tmp_path / "corpora" / "mini"
        folder.mkdir(parents=True, exist_ok=True)
        about = {k: v for k, v in MINI.items() if k != "annotation"}
        about |= {"downloads": {"m.bin": address or server.address}, "checksums": {"m.bin": sha256}}
        (folder / "corpus.yaml").write_text(yaml.safe_dump(about))
        (folder / "recordings.csv").write_text("recording,signer,motion\nr,s,m.bin\n")
        return load_corpus(folder)

    return make


def test_a_file_is_fetched_once_and_verified(corpus, server, tmp_path):
    (found,) = fetch(corpus(), tmp_path / "data")
    assert found.path.read_bytes() == CONTENT
    assert found.bytes == len(CONTENT)
    assert fetch(corpus(), tmp_path / "data")[0].bytes == 0
    assert server.asked == [None]
    found.path.write_bytes(b"changed")
    with pytest.raises(SignkinError, match=r"m\.bin: its SHA-256 is .*; expected .*Move it away"):
        fetch(corpus(), tmp_path / "data")
    assert found.path.read_bytes() == b"changed"


def test_a_file_cut_off_is_gone_on_with(corpus, server, tmp_path):
    server.most = 100_000
    with pytest.raises(SignkinError, match=r"100000 bytes came.*it goes on where this one stopped"):
        fetch(corpus(), tmp_path / "data")
    assert not (tmp_path / "data" / "m.bin").exists()
    server.most = None
    (found,) = fetch(corpus(), tmp_path / "data")
    assert found.bytes == len(CONTENT) - 100_000
    assert found.path.read_bytes() == CONTENT
    assert server.asked == [None, "bytes=100000-"]
    assert [p.name for p in (tmp_path / "data").iterdir()] == ["m.bin"]


@pytest.mark.parametrize("have", [CONTENT[:5000], CONTENT, CONTENT + b"more"])
@pytest.mark.parametrize("ranges", [True, False])
def test_a_part_of_any_length_ends_well(corpus, server, tmp_path, have, ranges):
    """Also where the server knows no ranges, and where all, or too much, is there already."""
    server.ranges = ranges
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "m.bin.part").write_bytes(have)
    (found,) = fetch(corpus(), tmp_path / "data")
    assert found.path.read_bytes() == CONTENT


def test_another_content_is_refused_and_not_kept(corpus, server, tmp_path):
    server.content = CONTENT[:-1] + b"\0"
    with pytest.raises(SignkinError, match=r"its SHA-256 is .*Is it another version"):
        fetch(corpus(), tmp_path / "data")
    assert not list((tmp_path / "data").iterdir())


def test_addresses_that_lead_nowhere_are_told(corpus, server, tmp_path):
    with pytest.raises(SignkinError, match=r"the server answers 404"):
        fetch(corpus(server.address.replace("m.bin", "gone")), tmp_path / "data")
    server.server_close()
    with pytest.raises(SignkinError, match=r"0 bytes came, then: \w+"):
        fetch(corpus(), tmp_path / "data")


def test_the_command_reads_corpora_dir_and_says_whom_to_cite(corpus, tmp_path, capsys, monkeypatch):
    corpus()
    (tmp_path / "corpora").rename(tmp_path / "mine")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SIGNKIN_DATA", raising=False)
    (tmp_path / "config.yaml").write_text("corpora_dir: mine\n")
    assert main(["corpus", "fetch", "mini"]) == 0
    assert (tmp_path / "mine" / "mini" / "data" / "m.bin").read_bytes() == CONTENT
    assert "Cite: none (licence: none)" in capsys.readouterr().out
    assert main(["corpus", "list"]) == 0
    assert "1 recordings  there" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"checksums": {}}, "downloads: m.bin has no SHA-256 under checksums"),
        ({"downloads": {"../m.bin": "https://a.org/m"}}, "the name of a file in the data folder"),
        ({"downloads": {"m.bin": "file:///etc/passwd"}}, "downloads.m.bin"),
    ],
)
def test_downloads_are_checked_before_anything_is_fetched(corpus, change, told):
    folder = corpus().folder
    about = yaml.safe_load((folder / "corpus.yaml").read_text())
    (folder / "corpus.yaml").write_text(yaml.safe_dump(about | change))
    with pytest.raises(SignkinError, match=told):
        load_corpus(folder)


def test_a_corpus_without_an_address_says_so(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["corpus", "fetch", "libras", "--data", str(tmp_path)]) == 1
    assert "no file with a public address" in capsys.readouterr().err
