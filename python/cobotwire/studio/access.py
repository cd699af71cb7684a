"""Decide who may talk to the server: the rules of host, origin and token, and the headers.

A page of another site can make the browser send requests here, and a name that resolves to
127.0.0.1 makes them look like our own (DNS rebinding). So each request must name this server as its
host, come from our page if it has an origin, and carry the token unless it is for a file of the
page. The page keeps the token where only its own origin, port included, can read it, and not in a
cookie, which the browser would send to every server on this machine.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field
from ipaddress import ip_address

# The subprotocol of the WebSocket. The token follows as a second one, because a page cannot set the
# headers of a WebSocket.
PROTOCOL = "cobotwire-studio"
TOKEN_PROTOCOL = "token."  # noqa: S105  (the prefix before a token)
HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}


@dataclass(frozen=True)
class Access:
    """Who may talk to a server that listens on ``host`` and ``port``.

    Attributes:
        token: the secret of this run; the address that is printed contains it.
    """

    host: str
    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24), repr=False)

    @property
    def loopback(self) -> bool:
        """Whether only programs on this machine can reach the server."""
        return self.host == "localhost" or (_is_ip(self.host) and ip_address(self.host).is_loopback)

    @property
    def url(self) -> str:
        """The address for the browser. What follows ``#`` is never sent over the network."""
        anywhere = _is_ip(self.host) and ip_address(self.host).is_unspecified
        host = "127.0.0.1" if anywhere else self.host
        shown = f"[{host}]" if ":" in host else host
        return f"http://{shown}:{self.port}/#token={self.token}"

    def refusal(self, method: str, path: str, headers: Mapping[str, str]) -> tuple[int, str] | None:
        """Return the status and the reason for which a request is refused; None: it may pass.

        ``method`` is ``WEBSOCKET`` for the start of a WebSocket. Names of headers are lower case.
        """
        host = headers.get("host", "")
        if not self._names_this_server(host):
            return 421, "this server has another address"
        origin = headers.get("origin")
        if origin is not None and origin != f"http://{host}":
            return 403, "requests from other sites are refused"
        if headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            return 403, "requests from other sites are refused"
        if method not in ("GET", "HEAD") and origin is None:
            return 403, "the request lacks its origin"
        if (method == "WEBSOCKET" or path.startswith("/api/")) and not self.knows(headers):
            return 401, "the token is missing or wrong; open the address that cobotwire printed"
        return None

    def _names_this_server(self, authority: str) -> bool:
        name, _, port = authority.rpartition(":")
        if port != str(self.port):
            return False
        name = name.removeprefix("[").removesuffix("]").lower()
        if self.loopback:
            return name == "localhost" or (_is_ip(name) and ip_address(name).is_loopback)
        # Rebinding needs a name, so every numeric address is harmless.
        return name in ("localhost", self.host.lower()) or _is_ip(name)

    def knows(self, headers: Mapping[str, str]) -> bool:
        """Return whether a request carries the token."""
        _, _, token = headers.get("authorization", "").partition("Bearer ")
        for protocol in headers.get("sec-websocket-protocol", "").split(","):
            if protocol.strip().startswith(TOKEN_PROTOCOL):
                token = protocol.strip().removeprefix(TOKEN_PROTOCOL)
        # In constant time, so that the time of a refusal tells nothing about the token.
        return hmac.compare_digest(token.encode(), self.token.encode())


def _is_ip(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True
