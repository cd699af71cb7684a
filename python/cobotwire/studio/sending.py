"""Decide which page may send which commands.

One page at a time may send. It may always send queries. Other commands need --allow-motion on the
command line, and the motion switch of the page.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.client.opening import settings
from cobotwire.inspect.call_arguments import parse
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.protocol.limits import Limits
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table
from cobotwire.session.request import EncodedRequest


class NotPermitted(CobotwireError):
    """A page may not send what it wants to send; nothing was sent."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.why = why


class Control:
    """Which page may send, and whether it may move the arm.

    Attributes:
        page: the page that may send; empty: none.
        motion: whether the motion switch of that page is on.
        motion_permitted: whether the command line permits motion.
    """

    def __init__(self, motion_permitted: bool) -> None:
        self.motion_permitted = motion_permitted
        self.page = ""
        self.motion = False

    def take(self, page: str) -> None:
        """Let a page send.

        Raises:
            NotPermitted: another page may send; it has to release the control first.
        """
        if self.page not in ("", page):
            raise NotPermitted("another page may send now; release the control there first")
        self.page = page

    def release(self, page: str) -> bool:
        """Let other pages send; return whether this page could."""
        if self.page != page:
            return False
        self.page, self.motion = "", False
        return True

    def switch_motion(self, page: str, on: bool) -> None:
        """Turn the motion switch of the page that may send.

        Raises:
            NotPermitted: another page may send, or the command line does not permit motion.
        """
        self.check_page(page)
        if on and not self.motion_permitted:
            raise NotPermitted(
                "the server was started without --allow-motion, so only queries may be sent"
            )
        self.motion = on

    def check_page(self, page: str) -> None:
        """Check that a page may send at all.

        Raises:
            NotPermitted: it may not.
        """
        if not page or page != self.page:
            raise NotPermitted("this page only watches; take the control before you send")

    def check(self, page: str, command: Command) -> None:
        """Check that a page may send a command.

        Raises:
            NotPermitted: it may not.
        """
        self.check_page(page)
        if command.safety != "query" and not (self.motion_permitted and self.motion):
            where = "in the page" if self.motion_permitted else "with --allow-motion"
            raise NotPermitted(
                f"{command.name} is not a query ({command.safety}): allow motion {where} first"
            )


class Preparer:
    """Turns the fields of a form into a request within the limits of the arm's client."""

    def __init__(
        self, table: Table, address: int | str | None = None, limits: Limits | None = None
    ) -> None:
        self._table = table
        sending = settings(table, None, None, None, limits)
        self._encoder = sending.encoder(find_address(table, address))

    def command(self, name: object) -> Command:
        """Return a command that can be sent.

        Raises:
            UsageError: there is none of that name.
        """
        if not isinstance(name, str):
            raise UsageError("command", name, "the name of a command")
        command = self._table.command(name)
        if command.event:
            message = f"{name} is an event, which the device sends without a request"
            raise UsageError("command", name, message=message)
        return command

    def arguments(self, command: Command, texts: object) -> dict[str, Any]:
        """Return the arguments of a command from the texts of a form; empty ones are left out.

        Raises:
            UsageError: an argument is missing or unknown, or its text is not a value of it.
        """
        if not isinstance(texts, Mapping):
            raise UsageError("arguments", texts, "texts by the name of the argument")
        for name, text in texts.items():
            if not isinstance(text, str) or not text.isprintable():
                raise UsageError(str(name), text, "a text that can be printed")
        return parse(command, [f"{name}={text}" for name, text in texts.items() if text])

    def encoded(self, command: Command, arguments: Mapping[str, Any]) -> EncodedRequest:
        """Return the request as it would be sent.

        Raises:
            UsageError: an argument is not allowed.
        """
        request: Request[Any] = command.request_type(**arguments)
        return self._encoder.encode_request(request)
