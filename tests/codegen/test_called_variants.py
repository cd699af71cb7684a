"""The arguments of a call choose the variant; the spec states their defaults and their order."""

from __future__ import annotations

import asyncio
import inspect
from pathlib import Path
from typing import Any

import pytest

import small_specs
from cobotwire import codec as codecs
from cobotwire.conformance.samples.raw import samples
from cobotwire.inspect.call_arguments import parse, request_values, variant_of
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import MemoryTransport, RunningClock, SteppedClock
from cobotwire_codegen.check import check
from memory_peer import MemoryPeer
from type_checkers import CHECKERS

COMMANDS = """
set_x:
  id: 0x10
  title: Set x
  doc: Sets x by one of two measures.
  safety: setting
  request_variants:
    - - {name: channel, type: small}
      - {name: heat, type: warmth}
      - {name: mode, type: mode}
      - {name: kind, type: small, const: 1}
    - - {name: channel, type: small}
      - {name: share, type: percent}
      - {name: kind, type: small, const: 2}
    - - {name: kind, type: tool, const: 15}
      - {name: channel, type: small}
set_gripper:
  id: 0xE8
  title: Set the gripper
  doc: Opens or closes the gripper.
  safety: setting
  arguments: [value, speed, gripper, limits, lean]
  request:
    - {name: gripper, type: tool, default: GRIPPER}
    - {name: unit, type: warmth, const: 15}
    - {name: value, type: percent}
    - {name: lean, type: angle, default: 90}
    - {name: speed, type: percent}
    - {name: limits, type: pair, default: [-1.5, 2]}
set_y:
  id: 0x11
  title: Set y
  doc: Sets y.
  safety: setting
  request_variants:
    - - {name: p, type: small}
      - {name: fast, type: flag, default: true}
    - - {name: r, type: big}
      - {name: kind, type: small, const: 3}
get_y:
  id: 0x12
  title: Read y
  doc: Reads y.
  safety: query
  reply_variants:
    - - {name: heat, type: warmth}
      - {name: mode, type: mode}
    - - {name: share, type: percent}
"""
VECTORS = """
- {name: a, command: set_x, direction: request, frame: FE FE 07 10 07 00 0F 01 01 FA, values: {channel: 7, heat: 1.5, mode: BLINK, kind: 1}}
- {name: b, command: set_x, direction: request, frame: FE FE 05 10 07 32 02 FA, values: {channel: 7, share: 50, kind: 2}}
- {name: c, command: set_x, direction: request, frame: FE FE 04 10 0F 07 FA, values: {kind: PUMP, channel: 7}}
- {name: d, command: set_gripper, direction: request, frame: FE FE 0D E8 0E 00 0F 0A 03 84 14 FF F1 00 14 FA,
   values: {gripper: GRIPPER, unit: 1.5, value: 10, lean: 90, speed: 20, limits: [-1.5, 2]}}
- {name: e, command: set_y, direction: request, frame: FE FE 04 11 05 01 FA, values: {p: 5, fast: true}}
- {name: f, command: set_y, direction: request, frame: FE FE 05 11 00 05 03 FA, values: {r: 5, kind: 3}}
- {name: g, command: get_y, direction: request, frame: FE FE 02 12 FA, values: {}}
- {name: h, command: get_y, direction: reply, frame: FE FE 05 12 00 0F 01 FA, values: {heat: 1.5, mode: BLINK}}
- {name: i, command: get_y, direction: reply, frame: FE FE 03 12 32 FA, values: {share: 50}}
"""  # noqa: E501  (a vector is one line)
CALLS: list[tuple[str, tuple[Any, ...], dict[str, Any], str]] = [
    ("set_x", (7,), {"heat": 1.5, "mode": 1}, "FE FE 07 10 07 00 0F 01 01 FA"),
    ("set_x", (7,), {"share": 50}, "FE FE 05 10 07 32 02 FA"),
    ("set_x", (7,), {}, "FE FE 04 10 0F 07 FA"),
    ("set_gripper", (10, 20), {}, "FE FE 0D E8 0E 00 0F 0A 03 84 14 FF F1 00 14 FA"),
    ("set_gripper", (10, 20, 15), {}, "FE FE 0D E8 0F 00 0F 0A 03 84 14 FF F1 00 14 FA"),
    ("set_gripper", (10, 20), {"lean": 0}, "FE FE 0D E8 0E 00 0F 0A 00 00 14 FF F1 00 14 FA"),
    ("set_y", (), {"p": 5}, "FE FE 04 11 05 01 FA"),
    ("set_y", (), {"p": 5, "fast": False}, "FE FE 04 11 05 00 FA"),
    ("set_y", (), {"r": 5}, "FE FE 05 11 00 05 03 FA"),
]
WRONG = [
    ("set_x", {"channel": 7, "heat": 1.5}, "missing its argument mode; it takes"),
    ("set_x", {"channel": 7, "share": 5, "mode": 1}, "mode together with channel and share"),
    ("set_y", {"p": 5, "r": 5}, r"it takes \(p, fast=True\) or \(r\)"),
    ("set_y", {"r": 5, "fast": True}, "does not take the argument fast together with r"),
    ("set_y", {}, "SetY.. is missing its argument"),
    ("set_x", {}, "channel"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("spec")


@pytest.fixture(scope="module")
def package(folder: Path) -> Any:
    edition = small_specs.build(folder, COMMANDS, VECTORS)
    check(edition)
    return small_specs.package(folder, edition)


@pytest.mark.parametrize(("name", "arguments", "named", "frame"), CALLS)
def test_call_sends_the_variant_that_its_arguments_choose(
    package: Any, name: str, arguments: tuple[Any, ...], named: dict[str, Any], frame: str
) -> None:
    peer, clock = MemoryPeer(), SteppedClock()
    with package.CLIENT(MemoryTransport(peer, clock), on_error="leave") as arm:
        getattr(arm, name)(*arguments, **named)
    assert peer.received == bytes.fromhex(frame)
    peer = MemoryPeer()

    async def call() -> None:
        async with package.ASYNC_CLIENT(MemoryTransport(peer, RunningClock())) as other:
            await getattr(other, name)(*arguments, **named)

    asyncio.run(call())
    assert peer.received == bytes.fromhex(frame)


@pytest.mark.parametrize(("name", "named", "words"), WRONG)
def test_other_arguments_are_rejected_before_a_byte_is_sent(
    package: Any, name: str, named: dict[str, Any], words: str
) -> None:
    peer = MemoryPeer()
    with package.CLIENT(MemoryTransport(peer, SteppedClock()), on_error="leave") as arm:
        with pytest.raises(TypeError, match=words):
            getattr(arm, name)(**named)
    assert peer.received == b""


def test_variants_of_a_reply_without_a_common_field_give_one_result(package: Any) -> None:
    results = []
    for frame in ("FE FE 05 12 00 0F 01 FA", "FE FE 03 12 32 FA"):
        peer = MemoryPeer(then=bytes.fromhex(frame))
        with package.CLIENT(MemoryTransport(peer, SteppedClock())) as arm:
            results.append(arm.get_y())
    assert results == [(1.5, package.Mode.BLINK, None), (None, None, 50)]
    reply = package.GetYReply(share=50)
    assert (reply.values, reply.result) == ((50,), (None, None, 50))
    with pytest.raises(TypeError, match="missing its argument mode"):
        _ = package.GetYReply(heat=1.5).values


def test_order_and_defaults_are_those_of_the_spec(package: Any) -> None:
    head = inspect.signature(package.CLIENT.set_gripper)
    assert str(head) == (
        "(self, value: 'int', speed: 'int', gripper: 'Tool | int' = 14, "
        "limits: 'Sequence[float]' = (-1.5, 2.0), lean: 'float' = 1.5707963267948966) -> 'None'"
    )
    assert "gripper: What is mounted (one of GRIPPER (14), PUMP (15); default: GRIPPER (14))." in (
        inspect.getdoc(package.CLIENT.set_gripper) or ""
    )
    table = package.TABLE.command("set_gripper")
    assert table.argument_names == ("value", "speed", "gripper", "limits", "lean")
    assert package.SetGripper(10, 20) == package.SetGripper(10, 20, 14)


@pytest.mark.parametrize(("name", "arguments", "named", "frame"), CALLS)
def test_words_of_the_command_line_choose_the_same_variant(
    package: Any, name: str, arguments: tuple[Any, ...], named: dict[str, Any], frame: str
) -> None:
    command = package.TABLE.command(name)
    words = [*map(str, arguments), *(f"{key}={float(word):g}" for key, word in named.items())]
    given = parse(command, [word.replace("fast=1", "fast=yes") for word in words])
    values, variant = request_values(command, given), variant_of(command, given)
    codec = codecs.load(package.TABLE, "reference")
    assert codec.encode(name, "request", values, variant=variant) == bytes.fromhex(frame)


def test_command_line_rejects_a_combination_that_no_variant_takes(package: Any) -> None:
    with pytest.raises(UsageError, match=r"set_y\(\) does not take the argument r together with p"):
        parse(package.TABLE.command("set_y"), ["p=5", "r=5"])


RIGHT = """
arm.set_x(1, heat=1.5, mode=1)
arm.set_x(1, share=5)
arm.set_x(1)
arm.set_gripper(10, 20)
arm.set_y(p=5, fast=False)
arm.set_y(r=5)
{package}.SetY(p=5)
{package}.SetX(1, share=5)
"""
WRONG_TYPES = """
arm.set_x(1, heat=1.5)
arm.set_x(1, 1.5, 1)
arm.set_x(1, share=5, mode=1)
arm.set_y(p=5, r=5)
arm.set_y(r=5, fast=True)
arm.set_y()
arm.set_gripper(10, 20, "PUMP")
{package}.SetY(p=5, r=5)
"""


def _checked(folder: Path, package: Any, lines: str, is_async: bool) -> str:
    name = package.__name__
    client = "AsyncSmall" if is_async else "Small"
    calls = lines.format(package=name).strip().splitlines()
    if is_async:
        calls = [f"await {line}" if line.startswith("arm.") else line for line in calls]
    body = "\n".join(f"    {line}" for line in calls)
    start = "async def" if is_async else "def"
    return f"import {name}\n\n\n{start} use(arm: {name}.{client}) -> None:\n{body}\n"


@pytest.mark.parametrize("checker", CHECKERS)
def test_type_checkers_reject_exactly_the_wrong_combinations(
    folder: Path, package: Any, checker: str, mypy_cache: str
) -> None:
    expected = set()
    for is_async in (False, True):
        for kind, lines in (("right", RIGHT), ("wrong", WRONG_TYPES)):
            path = folder / f"{kind}{is_async:d}.py"
            path.write_text(_checked(folder, package, lines, is_async))
            if kind == "wrong":
                expected |= {(path.name, 4 + line) for line in range(1, len(lines.splitlines()))}
    files = sorted(folder.glob("[rw]*[01].py"))
    found = CHECKERS[checker](folder, files, mypy_cache)
    assert {(name, line) for name, line, _ in found} == expected


def test_conformance_samples_contain_the_defaults(package: Any) -> None:
    [variant] = package.TABLE.command("set_gripper").request
    found = {sample.name: sample.raw_values for sample in samples(variant)}
    gripper, unit, _, lean, _, limits = found["defaults"]
    assert (gripper, unit, lean, limits) == ((14,), (15,), (900,), (-15, 20))
