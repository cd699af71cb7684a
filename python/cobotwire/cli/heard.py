"""What a simulated arm hears and answers, on a line: for people, or as JSON."""

from __future__ import annotations

import json
from typing import Any

from cobotwire.cli.call import plain
from cobotwire.codec.interface import Noise
from cobotwire.explain import summary
from cobotwire.session.device import Asked, DeviceEvent, Malformed


def in_line(client: int | None, event: DeviceEvent, answer: bytes) -> str:
    """In words; ``client`` is its number, None where there is only one."""
    whose = "" if client is None else f"{client:>3} "
    return whose + _in_words(event, answer)


def _in_words(event: DeviceEvent, answer: bytes) -> str:
    said = f"   answered {_hex(answer)}" if answer else ""
    if isinstance(event, Noise):
        return f"noise   {_hex(event.data)}   {event.reason}"
    if isinstance(event, Asked):
        return f"heard   {_hex(event.frame.data)}   {summary(event.message)}{said}"
    if isinstance(event, Malformed):
        return f"refused {_hex(event.frame.data)}   {event.error}"
    fields = ", ".join(f"{name}={value!r}" for name, value in event.fields.items())
    return f"text    of {event.command.name}: {fields}"


def in_json(client: int | None, event: DeviceEvent, answer: bytes) -> str:
    """As one JSON object."""
    whose: dict[str, Any] = {} if client is None else {"client": client}
    said = {"answer": _hex(answer)} if answer else {}
    return json.dumps({**whose, **_as_object(event), **said})


def _as_object(event: DeviceEvent) -> dict[str, Any]:
    if isinstance(event, Noise):
        return {"event": "noise", "data": _hex(event.data), "reason": event.reason}
    if isinstance(event, Asked):
        fields = {name: plain(value) for name, value in event.message.fields.items()}
        said = {"command": event.message.command.name, "fields": fields}
        return {"event": "heard", "data": _hex(event.frame.data), **said}
    if isinstance(event, Malformed):
        return {"event": "refused", "data": _hex(event.frame.data), "error": str(event.error)}
    return {"event": "text", "command": event.command.name, "fields": event.fields}


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()
