"""What a host session tells: one of these, or noise, for everything that is heard or not heard."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.codec.interface import Frame, Message, Noise
from cobotwire.errors import ProtocolError
from cobotwire.table import Command


class Answered(NamedTuple):
    """The reply that was waited for.

    ``message`` is None where it was text outside any frame. ``frame`` is None where its bytes were
    told before: as noise, which a text is, or as :class:`Echoed`.
    """

    command: Command
    fields: dict[str, Any]
    message: Message | None
    frame: Frame | None = None


class Refused(NamedTuple):
    """The reply that was waited for came, but the edition does not allow it."""

    command: Command
    error: ProtocolError
    frame: Frame | None = None


class Late(NamedTuple):
    """The reply to a question that was given up, or was answered already when asked again."""

    command: Command
    frame: Frame


class Acknowledged(NamedTuple):
    """The acknowledgement of an order."""

    command: Command
    message: Message
    frame: Frame


class Unasked(NamedTuple):
    """A legal frame that answers nothing."""

    frame: Frame


class Echoed(NamedTuple):
    """The very bytes of the question: an echo, or an answer that looks just like it.

    Which of the two shows only later; see :class:`cobotwire.session.echo.EchoWatch`.
    """

    frame: Frame


class Expired(NamedTuple):
    """The deadline passed; the question was asked ``tries`` times, first at ``asked_at``."""

    command: Command
    asked_at: float
    tries: int = 1


SessionEvent = Answered | Refused | Late | Acknowledged | Unasked | Echoed | Expired | Noise
