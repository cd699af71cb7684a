"""What a host session tells: one of these, or noise, for everything that is heard or not heard."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.codec.interface import Frame, Message, Noise
from cobotwire.errors import ProtocolError
from cobotwire.table import Command


class Answered(NamedTuple):
    """The reply that was waited for; ``message`` is None where it was text outside any frame."""

    command: Command
    fields: dict[str, Any]
    message: Message | None


class Refused(NamedTuple):
    """The reply that was waited for came, but the edition does not allow it."""

    command: Command
    error: ProtocolError


class Unasked(NamedTuple):
    """A legal frame that answers nothing that waits now."""

    frame: Frame


class Echoed(NamedTuple):
    """The very bytes of the question: an echo, or an answer that looks just like it.

    Which of the two shows only later; see :class:`cobotwire.session.echo.EchoWatch`.
    """

    frame: Frame


class Expired(NamedTuple):
    """The deadline passed."""

    command: Command
    asked_at: float


SessionEvent = Answered | Refused | Unasked | Echoed | Expired | Noise
