"""The reference client of MCP uses a simulated arm: in memory, and over stdio."""

from __future__ import annotations

import asyncio
import json
import os
import re
import sys
from collections.abc import Callable, Coroutine
from itertools import permutations
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import Limits, UsageError, editions
from cobotwire import codec as codecs
from cobotwire.editions import mercury_a1, mycobot280
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import Traffic
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import SimulatedArm, TcpServer

mcp = pytest.importorskip("mcp", reason="mcp is not installed: pip install 'cobotwire[mcp]'")
from mcp.client.stdio import StdioServerParameters, stdio_client  # noqa: E402

from cobotwire.adapters.mcp.server import ArmServer, Options  # noqa: E402
from cobotwire.adapters.mcp.tools import ToolSpec, tools  # noqa: E402

PAGE = Path(__file__).parents[2] / "docs" / "mcp.md"
STOP = bytes.fromhex("FE FE 02 29 FA")
SEND_ANGLES = 0x22
FAR = {"angles": [160, 0, 0, 0, 0, 0], "speed": 5}
MOTION = {"allow_motion": True, "limits": Limits(speed=100)}
Call = Callable[..., Coroutine[Any, Any, Any]]


def talk(
    work: Callable[[Any, Call], Coroutine[Any, Any, None]],
    edition: Any = mycobot280,
    **options: Any,
) -> list[bytes]:
    """Run a client, a server and an arm in this process; return the requests that arrived."""
    sent: list[bytes] = []

    def note(traffic: Traffic) -> None:
        if traffic.direction == "sent":
            sent.append(traffic.data)

    async def main() -> None:
        with TcpServer(SimulatedArm(edition.TABLE, powered=True).connect) as line:
            chosen = Options(line.url, edition.TABLE.edition, **options)
            arm = edition.ASYNC_CLIENT(line.url, limits=chosen.limits, trace=note)
            async with arm, ArmServer(arm, chosen) as served, mcp.Client(served.server) as client:

                async def call(name: str, **arguments: Any) -> Any:
                    done = await client.call_tool(name, arguments)
                    return done.content[0].text if done.is_error else done.structured_content

                await work(client, call)

    asyncio.run(main())
    return [each for each in sent if each[3] in (SEND_ANGLES, STOP[3])]


@pytest.mark.parametrize("name", ["mybuddy", "mycobot320", "myarm_c650"])
def test_smallest_arguments_of_a_schema_are_a_request_of_the_edition(name: str) -> None:
    table = editions.load(name).TABLE
    encoder = RequestEncoder(codecs.load(table))
    for spec in tools(table, Limits(), True, "all").values():
        jsonschema.Draft202012Validator.check_schema(spec.schema)
        known, first = spec.schema["properties"], spec.command.request[0].names
        # Some arguments exclude each other.
        names = [each for each in known if each in (*first, *spec.schema["required"])]
        given = {each: _least(known[each]) for each in names}
        jsonschema.validate(given, spec.schema)
        positional, arguments = spec.arguments(given)
        if not positional and not _has_groups(spec):
            encoder.encode_request(spec.command.request_type(**arguments))


def _least(schema: dict[str, Any]) -> Any:
    if "enum" in schema:
        return schema["enum"][0]
    if schema["type"] == "array":
        return [_least(schema["items"])] * schema.get("minItems", 1)
    return {"string": "00", "boolean": True}.get(schema["type"], schema.get("minimum", 1))


def _has_groups(spec: ToolSpec) -> bool:
    """Return whether an argument has another size than its schema says, or several ranges."""
    fields = [field for variant in spec.command.request for field in variant.fields]
    return any(f.many or f.selector >= 0 or f.kind in ("bytes", "text") for f in fields)


@pytest.mark.parametrize("name", ["move_angles", "move_coords"])
def test_order_of_json_keys_does_not_change_the_arguments_of_a_waited_motion(name: str) -> None:
    spec = tools(TABLE, Limits(), True)[name]
    values = {"angles": [0] * 6, "coords": [100, 0, 200, 0, 0, 0], "speed": 2, "mode": 1}
    given = [(each, values[each]) for each in spec.schema["properties"]]
    expected: Any = ([value for _, value in given], {})
    for order in permutations(given):
        assert spec.arguments(dict(order)) == expected


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=8) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=12,
)


SPECS = [*tools(TABLE, Limits(), True, "all").values()]


@given(st.data())
@settings(max_examples=50)
def test_any_json_is_a_request_or_an_error_of_the_caller(data: st.DataObject) -> None:
    spec = SPECS[data.draw(st.integers(0, len(SPECS) - 1))]
    names = st.sampled_from([*spec.schema["properties"], "x"])
    try:
        positional, arguments = spec.arguments(data.draw(st.dictionaries(names, JSON, max_size=4)))
        if not positional:
            request = spec.command.request_type(**arguments)
            RequestEncoder(codecs.load(TABLE)).encode_request(request)
    except UsageError:
        return


def test_only_queries_and_stop_are_offered_without_permission() -> None:
    async def work(client: Any, call: Call) -> None:
        offered = {tool.name: tool for tool in (await client.list_tools()).tools}
        others = [n for n, tool in offered.items() if not tool.annotations.read_only_hint]
        assert others == ["stop"]
        assert offered["get_angles"].annotations.destructive_hint is False
        found = await call("get_angles")
        assert found["result"] == dict.fromkeys((f"j{n}" for n in range(1, 7)), 0.0)
        assert found["units"]["j1"] == "degrees"
        assert (await call("get_coords"))["units"]["x"] == "millimetres"
        assert "--allow-motion" in await call("send_angles", **FAR)
        assert await call("xyz") == "there is no tool 'xyz'"
        assert "--tools all" in await call("get_encoder", joint=1)
        assert "no argument for 'x=1'" in await call("get_angles", x=1)
        assert await call("stop") == {"result": "sent"}

    assert talk(work) == [STOP]


def test_motion_keeps_the_limits_and_reports_its_end() -> None:
    async def work(client: Any, call: Call) -> None:
        offered = {tool.name: tool for tool in (await client.list_tools()).tools}
        assert offered["move_angles"].annotations.destructive_hint
        assert offered["move_angles"].input_schema["properties"]["speed"]["maximum"] == 100
        assert "speed is 101; allowed: " in await call("move_angles", **FAR | {"speed": 101})
        assert "angles.j1 is 169" in await call("move_angles", angles=[169] + [0] * 5, speed=9)
        found = await call("move_angles", angles=[5] + [0] * 5, speed=100)
        assert found == {"result": "the arm has arrived"}
        # The motion counts as ended when the arm reports the target as reached, within a tolerance.
        assert (await call("get_angles"))["result"]["j1"] == pytest.approx(5, abs=0.5)

    # The arm moved, so it is stopped when the client leaves.
    assert [each[3] for each in talk(work, **MOTION)] == [SEND_ANGLES, STOP[3]]


def test_stop_works_while_another_tool_waits_and_cancelling_that_tool_stops_the_arm() -> None:
    async def work(client: Any, call: Call) -> None:
        moving = asyncio.create_task(call("move_angles", **FAR))
        await asyncio.sleep(0.3)
        assert not moving.done()
        assert await call("stop") == {"result": "sent"}
        assert "stands still" in await moving
        again = asyncio.create_task(call("move_angles", **FAR))
        await asyncio.sleep(0.3)
        again.cancel()
        await asyncio.sleep(0.2)

    kinds = [each[3] for each in talk(work, **MOTION)]
    assert kinds[:2] == [SEND_ANGLES, STOP[3]]
    assert kinds.count(SEND_ANGLES) == 2
    assert STOP[3] in kinds[kinds.index(SEND_ANGLES, 1) :]


def test_motion_of_a_silent_client_is_stopped_once() -> None:
    async def work(client: Any, call: Call) -> None:
        await call("send_angles", **FAR)
        for _ in range(4):
            await asyncio.sleep(0.1)
            await call("is_moving")
        await asyncio.sleep(0.8)
        await call("is_moving")
        await asyncio.sleep(0.5)

    assert [each[3] for each in talk(work, silence=0.3, choice="all", **MOTION)] == [
        SEND_ANGLES,
        STOP[3],
    ]


@pytest.mark.parametrize("name", ["move_round", "resume"])
def test_motion_without_arguments_is_stopped_when_its_client_is_silent(name: str) -> None:
    async def work(client: Any, call: Call) -> None:
        assert await call(name) == {"result": "sent"}
        await asyncio.sleep(0.4)
        assert await call("pause") == {"result": "sent"}
        await asyncio.sleep(0.2)

    sent = talk(work, silence=0.1, choice="all", allow_motion=True)
    assert [each[3] for each in sent] == [STOP[3]]


@pytest.mark.parametrize("name", ["drag_teach_execute", "over_limit_return_zero", "resume"])
def test_motion_without_arguments_is_stopped_when_its_client_leaves(name: str) -> None:
    async def work(client: Any, call: Call) -> None:
        assert "result" in await call(name)

    sent = talk(work, mercury_a1, choice="all", allow_motion=True)
    assert [each[3] for each in sent] == [STOP[3]]


def test_configuration_of_the_page_serves_an_arm_over_stdio() -> None:
    blocks = re.findall(r"```json\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    started = json.loads(blocks[0])["mcpServers"]["arm"]
    assert started["command"] == "cobotwire"

    async def main() -> None:
        with TcpServer(SimulatedArm(TABLE, powered=True).connect) as line:
            words = [line.url if word == "/dev/ttyACM0" else word for word in started["args"]]
            program = ["-c", "from cobotwire.cli import main; main()", *words]
            parameters = StdioServerParameters(
                command=sys.executable, args=program, env={**os.environ}
            )
            async with mcp.Client(stdio_client(parameters)) as client:
                offered = [tool.name for tool in (await client.list_tools()).tools]
                found = await client.call_tool("get_angles", {})
                moved = await client.call_tool("move_angles", FAR | {"speed": 31})
        assert offered[0] == "stop"
        assert found.structured_content["result"]["j1"] == 0
        assert "speed is 31; allowed: a whole number 1..30 percent" in moved.content[0].text

    asyncio.run(main())
