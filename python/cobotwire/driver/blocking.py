"""The blocking driver."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, ClassVar, Self

from cobotwire import codec as codecs
from cobotwire.driver.line import SharedLine
from cobotwire.driver.opening import opened, seconds, settings
from cobotwire.driver.watching import Watcher, Watchers
from cobotwire.session import Conversation, Question, Request, RetryPolicy
from cobotwire.table import Table
from cobotwire.transport import Transport
from cobotwire.transport.timing import times_of

if TYPE_CHECKING:
    from cobotwire.driver.streaming import Stream
    from cobotwire.limits import Limits
    from cobotwire.session.sample import Query


class Driver:
    """An arm at the other end of a link; the generated clients add a method for each command.

    Orders are sent once and never again, also while another thread waits for an answer; one that
    nothing answers returns when its bytes are written. Questions take turns. Queries are asked
    again within their deadline, as ``retry`` says. After a question was given up, the next one like
    it is not sent until the late answer came, or has had its time: the two could not be told apart.

    Many threads may share one arm. Ctrl-C leaves it usable.
    """

    table: ClassVar[Table]

    def __init__(
        self,
        port: str | Transport,
        *,
        baudrate: int | None = None,
        timeout: float | None = None,
        retry: RetryPolicy | None = None,
        limits: Limits | None = None,
        codec: codecs.CodecName | None = None,
        trace: Watcher | None = None,
    ) -> None:
        """Open the link.

        Args:
            port: a serial port, or any URL that pyserial opens (``socket://host:port``); or an open
                transport.
            baudrate: bits a second; left out: what the edition says.
            timeout: seconds that the arm has to answer, asking again included; left out: what the
                edition says of the command.
            retry: how often queries are asked within that time; left out: up to three times.
            limits: where the arm may be sent, narrower or wider than the edition says.
            codec: ``native`` or ``reference``; left out: the one in use.
            trace: called with everything that goes over the line; see :meth:`watch`.

        Raises:
            UsageError: an argument is not allowed.
            LinkError: the port is not there, or cannot be opened.
        """
        self._settings = settings(self.table, timeout, retry, codec, limits)
        self.codec = self._settings.codec.name
        self._conversation = Conversation(self._settings.codec)
        self._link = opened(port, self.table, baudrate)
        self._times = times_of(self._link)
        self._watchers = Watchers(trace, self._link.url, self._times.now)
        self._line = SharedLine(self._link, self._conversation, self._watchers)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} on {self._link.url}, {self.codec} codec>"

    def close(self) -> None:
        """Give the link back. The arm is told nothing. Closing twice is harmless."""
        self._link.close()

    def watch(self, watcher: Watcher) -> Callable[[], None]:
        """Call ``watcher`` with everything that goes over the line from now on, as it goes.

        It is called in whichever thread reads or writes: it must be quick, and must not raise.
        Bytes that come while nobody waits are read, and told, with the next call, or by
        :meth:`listen`.

        Returns:
            What ends it, when called.
        """
        return self._watchers.add(watcher)

    def listen(self, seconds: float) -> None:
        """Read what comes unasked, for so many seconds; whoever watches is told of it.

        Raises:
            LinkError: the link is gone.
        """
        self._line.listen(seconds)

    def stream(self, *queries: Query, rate: float, timeout: float | None = None) -> Stream:
        """Samples of what queries answer, so many times a second.

            for sample in arm.stream("get_angles", "get_coords", rate=20):
                angles, coords = sample.values

        The arm is asked only when the loop wants a sample, so a slow loop misses samples and heaps
        up none. A sample that is missed is missed: it is counted in the stream's ``report``, and
        nothing is caught up. A question is sent once; the next slot asks again anyway. After one
        that was not answered, the next like it may have to wait: see ``RetryPolicy.grace``.

        Args:
            queries: names of commands of safety class query; with arguments as a tuple:
                ``("get_encoder", 2)``.
            rate: samples a second, above 0 and up to 1000.
            timeout: seconds that each question has; left out: as in other calls.

        Returns:
            The stream. Its loop raises LinkError when the link is gone, and nothing else.

        Raises:
            UsageError: an argument is not allowed, or is no query; nothing was sent.
        """
        # Here, not above: few programs stream, and all of them import this.
        from cobotwire.driver.streamed import streamed
        from cobotwire.driver.streaming import Stream

        chosen = self._settings.for_stream(timeout)

        def ask(request: Request) -> Question:
            return self._line.ask(request, chosen.retry, chosen.timeout)

        asked = streamed(type(self), self.table, queries, self._conversation.prepare)
        return Stream(ask, asked, rate, self._times)

    def _tell(
        self,
        name: str,
        values: Sequence[Any],
        text_values: Mapping[str, str] | None = None,
        ack_within: float | None = None,
    ) -> None:
        """Send an order at once; wait for its acknowledgement if ``ack_within`` says how long."""
        seconds("ack_within", ack_within)
        self._line.tell(self._conversation.prepare(name, values, text_values), ack_within)

    def _ask(
        self, name: str, values: Sequence[Any], *, longest: float | None = None
    ) -> dict[str, Any]:
        """Ask a question and wait for its reply; gives the reply's fields by name.

        ``longest`` is less than the usual seconds, where the caller has less time.
        """
        request = self._conversation.prepare(name, values)
        chosen = self._settings
        wait = chosen.timeout if longest is None else chosen.at_most(longest, request.command)
        return self._line.ask(request, chosen.retry, wait).result()
