"""Run the server: open the arm or the recording, listen, print the address, end with Ctrl-C."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
import webbrowser
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import ExitStack, asynccontextmanager, contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

import uvicorn
from starlette.applications import Starlette

from cobotwire import editions
from cobotwire.capture import is_capture, read
from cobotwire.editions import Edition
from cobotwire.inspect.following import SCHEME, FollowedRecording
from cobotwire.kinematics.urdf_reading import with_urdf
from cobotwire.protocol.addresses import check_one_moves
from cobotwire.protocol.errors import CobotwireError, LinkError, UsageError
from cobotwire.protocol.limits import Limits
from cobotwire.studio.accepting import Server
from cobotwire.studio.access import Access
from cobotwire.studio.app import make_app
from cobotwire.studio.arm_line import ArmLine, PortOptions
from cobotwire.studio.connections import Connections
from cobotwire.studio.live import REMARKS, LiveSession
from cobotwire.studio.recorded import RecordedSession
from cobotwire.studio.sending import Control
from cobotwire.studio.simulated_line import SimulatedLine
from cobotwire.studio.stage import LONGEST_SILENCE_SECONDS, Stage

FASTEST_POLL = 200.0
# What pages send is small.
LARGEST_MESSAGE = 4096
# Open pages have this long to close their connections at the end.
END_SECONDS = 2


class Options(NamedTuple):
    """What to show and how.

    Attributes:
        source: a port, a URL, the file of a recording, ``follow:FILE`` for one that grows; None: a
            simulated arm.
        edition: the name of the edition.
        baudrate, record, address: as for the other subcommands.
        rate: how often a second the arm is polled; 0: never.
        host, port: where the server listens; port 0: any that is free.
        allow_motion: whether pages may send anything but queries.
        open_browser: whether to open the page.
        limits: the limits that the arm's client enforces.
        silence: seconds without a message from the page after which a motion that lasts while a
            button is held is stopped.
        geometry, tip: the URDF of the arm to draw and simulate, and the link of its flange.
    """

    source: str | None
    edition: str
    baudrate: int | None = None
    record: str | None = None
    address: int | str | None = None
    rate: float = 10.0
    host: str = "127.0.0.1"
    port: int = 0
    allow_motion: bool = False
    open_browser: bool = True
    limits: Limits | None = None
    silence: float = LONGEST_SILENCE_SECONDS
    geometry: str | None = None
    tip: str | None = None


def serve(options: Options, announce: Callable[[Access], None]) -> None:
    """Serve until Ctrl-C or SIGTERM. ``announce`` gets the address when the server listens.

    If pages may move the arm, it is sent ``stop`` at the end.

    Raises:
        UsageError: an option is not allowed, or a recording does not exist. With
            ``allow_motion``, an address is required if motions go to all devices by default.
        LinkError: the port cannot be opened, or the address cannot be listened on.
        CaptureError: the file is not a recording.
    """
    if not 0 <= options.rate <= FASTEST_POLL:
        raise UsageError("rate", options.rate, f"0..{FASTEST_POLL:g}")
    with _listening(options.host, options.port) as listening, staged(options) as stage:
        access = Access(options.host, listening.getsockname()[1])

        @asynccontextmanager
        async def lifespan(app: Starlette) -> AsyncIterator[None]:
            announce(access)
            if options.open_browser:
                # In a thread: some browsers return only when they are closed.
                opening = threading.Thread(target=webbrowser.open, args=(access.url,), daemon=True)
                opening.start()
            tasks = []
            if isinstance(stage.session, LiveSession):
                tasks.append(asyncio.create_task(stage.session.pump()))
            yield
            for task in tasks:
                task.cancel()

        connections = Connections()
        config = uvicorn.Config(
            make_app(stage, access, connections, lifespan),
            ws="websockets-sansio",
            ws_max_size=LARGEST_MESSAGE,
            ws_per_message_deflate=False,
            log_level="error",
            access_log=False,
            server_header=False,
            proxy_headers=False,
            timeout_graceful_shutdown=END_SECONDS,
        )
        Server(config, listening, connections).run()


@contextmanager
def staged(options: Options) -> Iterator[Stage]:
    """Yield what the server shows; close everything at the end.

    Raises:
        CobotwireError: as :func:`serve`.
    """
    edition = editions.load(options.edition)
    table = with_urdf(edition.TABLE, options.geometry, options.tip)
    with ExitStack() as stack:
        if (shown := _recorded(options, stack)) is not None:
            edition, session = shown
            table = with_urdf(edition.TABLE, options.geometry, options.tip)
            stage = Stage(edition, session, Control(False), drawn=table)
            stack.callback(stage.close)
            yield stage
            return
        remarks: deque[tuple[float, str, str]] = deque(maxlen=REMARKS)
        simulated = None
        url = options.source
        if url is not None and options.allow_motion:
            check_one_moves(edition.TABLE, options.address)
        if url is None:

            def remark(label: str, text: str) -> None:
                remarks.append((time.monotonic(), label, text))

            simulated = stack.enter_context(SimulatedLine(table, remark))
            url = simulated.url
        port = PortOptions(url, options.baudrate, options.record, options.address, options.limits)
        line = stack.enter_context(ArmLine(edition, port, options.rate))
        if options.allow_motion:
            stack.callback(_stop_at_end, line)
        # Motions of a simulated arm are harmless, so they need no option.
        control = Control(options.allow_motion or simulated is not None)
        stage = Stage(
            edition,
            LiveSession(line, remarks),
            control,
            simulated,
            options.address,
            options.limits,
            options.silence,
            table,
        )
        stack.callback(stage.close)
        yield stage


def _recorded(
    options: Options, stack: ExitStack
) -> tuple[Edition, LiveSession | RecordedSession] | None:
    """Return the recording that is shown, finished or still growing; None for an arm."""
    source, edition = options.source, editions.load(options.edition)
    if source is not None and source.startswith(SCHEME):
        if options.record is not None or options.allow_motion:
            message = "with follow:FILE there is nothing to record, and nothing moves"
            raise UsageError("source", source, message=message)
        followed = stack.enter_context(FollowedRecording(source, options.edition))
        return followed.edition, LiveSession(followed, deque())
    if source is None or not _is_recording(source):
        return None
    session = RecordedSession(source, options.edition)
    return _edition_of(session, edition), session


def _stop_at_end(line: ArmLine) -> None:
    # Nobody watches any longer. If it cannot be sent, the port is gone or the edition has none.
    with suppress(CobotwireError):
        line.stop()


def _edition_of(session: RecordedSession, default: Edition) -> Edition:
    name = session.codec.table.edition
    return editions.load(name) if name in editions.names() else default


def _is_recording(source: str) -> bool:
    path = Path(source)
    if not path.is_file():
        return source.endswith(".pcapng")
    with path.open("rb") as file:
        start = file.read(12)
    if source.endswith((".gz", ".zst", ".pcapng")) or is_capture(start):
        return True
    with read(source) as capture:
        return capture.foreign is not None


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    # A host that is no valid name raises UnicodeError, and a port that is too high OverflowError.
    except (OSError, UnicodeError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise LinkError(f"{host}:{port}", f"cannot listen: {reason}") from error
