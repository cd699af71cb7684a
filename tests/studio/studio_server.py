"""Start ``cobotwire studio`` as users do, and talk to it."""

from __future__ import annotations

import http.client
import json
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple
from urllib.parse import urlsplit

SECONDS = 30


class Answer(NamedTuple):
    """The answer to a request."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def json(self) -> Any:
        """The body as JSON."""
        return json.loads(self.body)


class Studio(NamedTuple):
    """A running server; when it has ended, ``log`` has what it wrote to its error output."""

    process: subprocess.Popen[str]
    url: str
    log: list[str]

    @property
    def port(self) -> int:
        """The port that it listens on."""
        return urlsplit(self.url).port or 0

    @property
    def token(self) -> str:
        """The secret in its URL."""
        return urlsplit(self.url).fragment.removeprefix("token=")

    @property
    def origin(self) -> str:
        """The origin of its page."""
        return f"http://127.0.0.1:{self.port}"

    def request(
        self,
        path: str,
        *,
        method: str = "GET",
        headers: Mapping[str, str] | None = None,
        body: Any = None,
    ) -> Answer:
        """Send a request with exactly these headers besides the host and the length."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=SECONDS)
        given = dict(headers or {})
        data = None if body is None else body if isinstance(body, bytes) else json.dumps(body)
        try:
            connection.putrequest(method, path, skip_host="host" in given)
            if data is not None and "transfer-encoding" not in given:
                given["content-length"] = str(len(data))
            for name, value in given.items():
                connection.putheader(name, value)
            connection.endheaders(data.encode() if isinstance(data, str) else data)
            response = connection.getresponse()
            found = {name.lower(): value for name, value in response.getheaders()}
            return Answer(response.status, found, response.read())
        finally:
            connection.close()

    @property
    def own(self) -> dict[str, str]:
        """The headers of a request of the page."""
        return {"authorization": f"Bearer {self.token}", "origin": self.origin}

    def get(self, path: str) -> Answer:
        """Request something as the page does."""
        return self.request(path, headers=self.own)

    def post(self, path: str, body: Any, page: str = "") -> Answer:
        """Send something as the page does."""
        headers = {**self.own, "x-studio-page": page}
        return self.request(path, method="POST", headers=headers, body=body)


@contextmanager
def running(*words: str, edition: str = "mycobot280", first: str = "") -> Iterator[Studio]:
    """Run a server, after the Python statements in ``first``; end it with Ctrl-C, as users do."""
    script = f"{first}\nfrom cobotwire.cli import main; main()"
    command = [sys.executable, "-c", script, "--edition", edition, "studio", "--no-browser", *words]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    log: list[str] = []
    try:
        url = process.stdout.readline().strip()
        assert url, process.communicate(timeout=SECONDS)
        yield Studio(process, url, log)
    finally:
        process.send_signal(signal.SIGINT)
        try:
            log.append(process.communicate(timeout=SECONDS)[1])
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise
