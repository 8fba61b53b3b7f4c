"""An S3 server on this machine's loopback (moto's), which can answer 503 at first."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

BUSY = b"<Error><Code>SlowDown</Code><Message>Please reduce your request rate.</Message></Error>"


def why_not() -> str:
    """Return why no server can be started here, or none be used; '' where one can."""
    for module in ("moto", "boto3", "snakemake_storage_plugin_s3"):
        if find_spec(module) is None:
            return f"{module} is not installed: pip install 'signkin[s3]' 'moto[server,s3]'"
    return ""


@dataclass
class Server:
    """A running server. refused: how often each request (method, path) was answered 503."""

    address: str
    refused: Counter[tuple[str, str]] = field(default_factory=Counter)

    @property
    def environment(self) -> dict[str, str]:
        """What Snakemake and its plugin are told by."""
        return {
            "SNAKEMAKE_STORAGE_S3_ENDPOINT_URL": self.address,
            "SNAKEMAKE_STORAGE_S3_ACCESS_KEY": "any",
            "SNAKEMAKE_STORAGE_S3_SECRET_KEY": "any",
        }

    def bucket(self, name: str) -> Any:
        """Return a bucket, made where it is not there."""
        import boto3

        s3 = boto3.resource("s3", endpoint_url=self.address, region_name="us-east-1",
                            aws_access_key_id="any", aws_secret_access_key="any")  # fmt: skip
        return s3.create_bucket(Bucket=name)

    def put(self, folder: Path, bucket: str, prefix: str) -> None:
        """Upload the files of a folder."""
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                key = f"{prefix}/{path.relative_to(folder).as_posix()}"
                self.bucket(bucket).upload_file(str(path), key)

    def get(self, bucket: str, prefix: str, folder: Path) -> None:
        """Download what lies below a prefix."""
        there = self.bucket(bucket)
        for item in there.objects.filter(Prefix=f"{prefix}/"):
            path = folder / item.key.removeprefix(f"{prefix}/")
            path.parent.mkdir(parents=True, exist_ok=True)
            there.download_file(item.key, str(path))


@contextmanager
def loopback(refusals: int = 0, most: int = 40) -> Iterator[Server]:
    """Start a server that answers each of the first requests (method, path) 503 so many times.

    most: how many. boto3 gives up after about a hundred retries that few successes lie between.
    """
    from moto.server import DomainDispatcherApplication, create_backend_app
    from werkzeug.serving import make_server

    served = DomainDispatcherApplication(create_backend_app)
    guard = threading.Lock()

    def application(environ: dict[str, Any], start_response: Any) -> Any:
        request = environ["REQUEST_METHOD"], environ["PATH_INFO"]
        with guard:
            known = request in server.refused or len(server.refused) < most
            refuse = known and server.refused[request] < refusals
            if refuse:
                server.refused[request] += 1
        if refuse:
            environ["wsgi.input"].read(int(environ.get("CONTENT_LENGTH") or 0))
            start_response("503 Slow Down", [("Content-Type", "application/xml")])
            return [BUSY]
        return served(environ, start_response)

    http = make_server("127.0.0.1", 0, application, threaded=True)
    server = Server(f"http://127.0.0.1:{http.server_port}")
    thread = threading.Thread(target=http.serve_forever, daemon=True)
    thread.start()
    try:
        yield server
    finally:
        http.shutdown()
        thread.join()
