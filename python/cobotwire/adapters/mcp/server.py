"""Serve one arm to one client of MCP on stdin and stdout, until that client ends."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import AsyncIterator, Coroutine
from contextlib import suppress
from typing import Any, NamedTuple, cast

from mcp import types
from mcp.server import Server, ServerRequestContext
from mcp.server.stdio import stdio_server

import cobotwire
from cobotwire import editions
from cobotwire.adapters.mcp.tools import STOP, Choice, tools
from cobotwire.client.aio import AsyncClient
from cobotwire.client.aio_dead_man import AsyncDeadMan
from cobotwire.protocol.errors import CobotwireError, UsageError, did_you_mean
from cobotwire.protocol.limits import Limits
from cobotwire.protocol.roles import may_move

Context = ServerRequestContext[Any]
INSTRUCTIONS = (
    "These tools control a robot arm, {title}. {motion} Results have their units. "
    "stop works at any time, also while another tool waits."
)
MOVES = "It really moves: read its position first, move slowly, and keep people safe."
WATCHES = (
    "Only queries are permitted. To move it, the user must start the server with --allow-motion."
)


class Options(NamedTuple):
    """The arm, and what a client of MCP may do with it.

    Without ``allow_motion`` only queries and stop are sent. A motion is stopped after ``silence``
    seconds without a message. ``choice`` selects the tools.
    """

    port: str
    edition: str
    baudrate: int | None = None
    record: str | None = None
    address: int | str | None = None
    allow_motion: bool = False
    limits: Limits = Limits()
    silence: float = 60.0
    choice: Choice = "basic"


class ArmServer:
    """The tools of one arm with an open port. Leaving the ``async with`` block stops a motion."""

    def __init__(self, arm: AsyncClient, options: Options) -> None:
        self._arm, self._options = arm, options
        self._tools = tools(arm.table, options.limits, options.allow_motion, options.choice)
        self._tasks: set[asyncio.Task[Any]] = set()
        self._moving, self._stops = False, 0
        watched = options.allow_motion and STOP in self._tools
        self._dead_man = AsyncDeadMan(arm, options.silence) if watched else None
        motion = MOVES if options.allow_motion else WATCHES
        self.server = Server(
            "cobotwire",
            version=cobotwire.__version__,
            instructions=INSTRUCTIONS.format(title=arm.table.title, motion=motion),
            on_list_tools=self._list,
            on_call_tool=self._call,
            on_ping=self._ping,
        )

    async def __aenter__(self) -> ArmServer:
        if self._dead_man is not None:
            await self._dead_man.__aenter__()
            self._dead_man.rest()
        return self

    async def __aexit__(self, *error: object) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._dead_man is not None:
            await self._dead_man.__aexit__()
            if self._moving:
                # If stop cannot be sent, the port is gone.
                with suppress(CobotwireError):
                    await self._arm._stop_all()

    def _note_message(self, moves: bool) -> None:
        """Note a message of the client. The dead man's switch is active from a motion to a stop."""
        if self._dead_man is None:
            return
        if self._dead_man.stops != self._stops:
            self._stops, self._moving = self._dead_man.stops, False
        self._moving = self._moving or moves
        if self._moving:
            self._dead_man.alive()

    async def _ping(self, context: Context, params: object) -> types.EmptyResult:
        self._note_message(False)
        return types.EmptyResult()

    async def _list(self, context: Context, params: object) -> types.ListToolsResult:
        self._note_message(False)
        shown = [
            types.Tool(
                name=spec.name,
                title=spec.command.title,
                description=spec.description,
                input_schema=spec.schema,
                annotations=types.ToolAnnotations.model_validate(spec.hints),
            )
            for spec in self._tools.values()
        ]
        return types.ListToolsResult(tools=shown)

    async def _call(
        self, context: Context, params: types.CallToolRequestParams
    ) -> types.CallToolResult:
        result: dict[str, Any] | None = None
        try:
            result = await self._run(self._send(params.name, params.arguments or {}))
            text = json.dumps(result, ensure_ascii=False)
        except CobotwireError as error:
            text = str(error)
        return types.CallToolResult(
            content=[types.TextContent(type="text", text=text)],
            structured_content=result,
            is_error=result is None,
        )

    async def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        """Run a call in its own task. If the call is cancelled, that task stops its motion."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        try:
            return await asyncio.shield(task)
        except asyncio.CancelledError:
            task.cancel()
            raise

    async def _send(self, name: str, arguments: dict[str, Any]) -> dict[str, Any]:
        spec = self._tools.get(name)
        if spec is None:
            raise UsageError("name", name, message=self._unknown(name))
        if name == STOP:
            await self._arm._stop_all()
            self._moving = False
            if self._dead_man is not None:
                self._dead_man.rest()
            return spec.result(None)
        positional, named = spec.arguments(arguments)
        self._note_message(may_move(self._arm.table, spec.command))
        return spec.result(await getattr(self._arm, name)(*positional, **named))

    def _unknown(self, name: str) -> str:
        everything = tools(self._arm.table, Limits(), True, "all")
        if name not in everything:
            return f"there is no tool {name!r}{did_you_mean(name, self._tools)}"
        command = everything[name].command
        if command.safety != "query" and not self._options.allow_motion:
            return (
                f"{name} is not a query ({command.safety}): the user must start the server with "
                "--allow-motion to permit it"
            )
        return f"{name} is not offered: the limits refuse it, or it needs --tools all"


def serve(options: Options) -> None:
    """Serve until the client closes stdin, or Ctrl-C.

    Raises:
        UsageError: an option is not allowed.
        LinkError: the port cannot be opened.
        CaptureError: the recording is incomplete.
    """
    try:
        asyncio.run(_serve(options))
    except* BrokenPipeError:
        pass  # The client is gone; the arm was stopped.


async def _lines() -> AsyncIterator[str]:
    """Yield the lines of stdin; a thread waits for them, but does not keep the program alive."""
    loop, lines = asyncio.get_running_loop(), asyncio.Queue[str | None]()

    def read() -> None:
        # The loop may have ended.
        with open(0, "rb", closefd=False) as file, suppress(RuntimeError):
            for line in file:
                loop.call_soon_threadsafe(lines.put_nowait, line.decode("utf-8", "replace"))
            loop.call_soon_threadsafe(lines.put_nowait, None)

    threading.Thread(target=read, daemon=True).start()
    while (line := await lines.get()) is not None:
        yield line


async def _serve(options: Options) -> None:
    client = editions.load(options.edition).ASYNC_CLIENT
    arm = client(
        options.port,
        options.baudrate,
        limits=options.limits,
        record=options.record,
        address=options.address,
    )
    async with (
        arm,
        ArmServer(arm, options) as served,
        stdio_server(cast(Any, _lines())) as (received, sent),
    ):
        server = served.server
        await server.run(received, sent, server.create_initialization_options())
