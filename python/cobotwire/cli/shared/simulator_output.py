"""Format what a simulated arm receives and replies: as lines, or as JSON.

``client`` is the number of a client; None if there is only one.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from cobotwire.cli.shared.output import as_hex
from cobotwire.codec.interface import Noise
from cobotwire.diagnose.explain import format_message
from cobotwire.protocol.json_values import as_json_value
from cobotwire.protocol.printable import printable
from cobotwire.protocol.table import Table
from cobotwire.session.device import DeviceEvent, MalformedRequest, RequestReceived
from cobotwire.simulator.arm import Note

if TYPE_CHECKING:
    from cobotwire.simulator.faults import AppliedFault


def left_out(lines: int) -> str:
    """Return the line that stands for lines that were left out."""
    return f"... {lines} lines are left out: nobody read them in time"


class Lines:
    """Formats a line for people."""

    def serving(self, url: str, table: Table) -> str:
        """Format the first line: the port to open; a remark about the geometry may follow."""
        remark = table.robot.geometry_remark
        return f"{url}\n{self._line(None, 'note', remark)}" if remark else url

    def event(self, client: int | None, event: DeviceEvent, reply: bytes) -> str:
        """Format what the arm received, and its reply."""
        if isinstance(event, Noise):
            return self._line(client, "noise", f"{as_hex(event.data)}   {event.reason}")
        if isinstance(event, RequestReceived):
            replied = f"   reply {as_hex(reply)}" if reply else ""
            text = f"{as_hex(event.frame.data)}   {format_message(event.message)}{replied}"
            return self._line(client, "received", text)
        if isinstance(event, MalformedRequest):
            return self._line(client, "rejected", f"{as_hex(event.frame.data)}   {event.error}")
        fields = ", ".join(f"{name}={value!r}" for name, value in event.fields.items())
        return self._line(client, "text", f"of {event.command.name}: {fields}")

    def fault(self, client: int | None, done: AppliedFault) -> str:
        """Format a fault that a scenario injected."""
        return self._line(client, "fault", printable(str(done)))

    def note(self, note: Note) -> str:
        """Format why the arm ignored a request."""
        return self._line(None, "note", f"{note.command}: {note.text}")

    def left_out(self, lines: int) -> str:
        """Format how many lines were left out, because the output was not read."""
        return left_out(lines)

    def _line(self, client: int | None, kind: str, text: str) -> str:
        line = f"{kind:<8} {text}"
        return line if client is None else f"{client:>3} {line}"


class JsonLines:
    """Formats a JSON object per line."""

    def serving(self, url: str, table: Table) -> str:
        """Format the first line: the port to open, and a remark about the geometry."""
        remark = table.robot.geometry_remark
        remarks = {"geometry": remark} if remark else {}
        return self._object(None, {"event": "serving", "url": url, **remarks})

    def event(self, client: int | None, event: DeviceEvent, reply: bytes) -> str:
        """Format what the arm received, and its reply."""
        return self._object(client, self._event(event, reply))

    def _event(self, event: DeviceEvent, reply: bytes) -> dict[str, Any]:
        if isinstance(event, Noise):
            return {"event": "noise", "data": as_hex(event.data), "reason": event.reason}
        if isinstance(event, RequestReceived):
            fields = {name: as_json_value(value) for name, value in event.message.fields.items()}
            address = event.message.address
            return {
                "event": "received",
                "data": as_hex(event.frame.data),
                "command": event.message.command.name,
                **({} if address is None else {"address": address}),
                "fields": fields,
                **({"reply": as_hex(reply)} if reply else {}),
            }
        if isinstance(event, MalformedRequest):
            data = as_hex(event.frame.data)
            return {"event": "rejected", "data": data, "error": str(event.error)}
        return {"event": "text", "command": event.command.name, "fields": event.fields}

    def fault(self, client: int | None, done: AppliedFault) -> str:
        """Format a fault that a scenario injected."""
        return self._object(client, {"event": "fault", **done._asdict()})

    def note(self, note: Note) -> str:
        """Format why the arm ignored a request."""
        return self._object(None, {"event": "note", **note._asdict()})

    def left_out(self, lines: int) -> str:
        """Format how many lines were left out, because the output was not read."""
        return self._object(None, {"event": "left out", "lines": lines})

    def _object(self, client: int | None, content: dict[str, Any]) -> str:
        return json.dumps(content if client is None else {"client": client, **content})
