"""Explain errors by the firmware of an arm, if the arm has reported its version."""

from __future__ import annotations

from typing import Any

from cobotwire.protocol.errors import ReplyTimeout, RequestRefused
from cobotwire.protocol.table import Command
from cobotwire.session.pending import Pending


class ReportedFirmware:
    """The version that the arm on a connection has reported; no query is sent to learn it."""

    def __init__(self) -> None:
        self.version: float | None = None

    def result(self, pending: Pending) -> dict[str, Any]:
        """Return the fields of a reply, or raise its error, which states the firmware needed.

        Raises:
            CobotwireError: the reason why there is no reply.
        """
        command = pending.request.command
        try:
            fields = pending.result()
        except (ReplyTimeout, RequestRefused) as error:
            needs = self.needs(command)
            if needs and needs not in str(error):
                error.args = (f"{error}; {needs}",)
            raise
        if command.role == "version":
            reported = next(iter(fields.values()), None)
            self.version = float(reported) if isinstance(reported, int | float) else None
        return fields

    def needs(self, command: Command) -> str:
        """Return which firmware a command needs and the arm lacks; empty if none is known."""
        stated, version = command.firmware, self.version
        if stated is None or version is None:
            return ""
        reported = f"the arm has reported {version:.1f}"
        for key, words in (("since", "needs"), ("reply_since", "gets a reply since")):
            if version < stated.get(key, 0.0):
                return f"{command.name} {words} firmware {stated[key]:.1f}, and {reported}"
        if version >= stated.get("until", version + 1):
            return f"{command.name} was removed in firmware {stated['until']:.1f}, and {reported}"
        return ""
