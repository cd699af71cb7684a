"""Check, generate, import, call and simulate random protocols.

``tests/targets/vectors`` compares their vectors with both codecs.
"""

from __future__ import annotations

import itertools
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import random_specs
from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.protocol.effects import Stores, effect_of
from cobotwire.protocol.errors import ReplyTimeout, UsageError
from cobotwire.session import RetryPolicy
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Command, Edition, Field, Value, Variant, Vector, named_fields
from cobotwire_codegen.render import render_python
from cobotwire_codegen.wire import build_frame, encode_variant
from memory_peer import MemoryPeer
from random_values import as_codec, counted, type_of
from small_specs import package

NUMBERS = itertools.count()
EXAMPLES = settings(
    max_examples=25,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


def _variant(edition: Edition, vector: Vector) -> int:
    command = next(c for c in edition.commands if c.name == vector.command)
    variant, _ = encode_variant(command, vector.direction, dict(vector.values))
    return command.variants(vector.direction).index(variant)


def _values(edition: Edition, vector: Vector) -> tuple[Any, ...]:
    """Return a vector's values as the codecs take and return them."""
    command = next(c for c in edition.commands if c.name == vector.command)
    values = dict(vector.values)
    variant, _ = encode_variant(command, vector.direction, values)
    return tuple(as_codec(type_of(field, values), values[field.name]) for field in variant)


@EXAMPLES
@given(st.data())
def test_simulated_arm_of_a_random_protocol_sends_legal_replies(
    tmp_path: Path, data: st.DataObject
) -> None:
    _, edition = data.draw(random_specs.specs(tmp_path))
    table = package(tmp_path, edition).TABLE
    codec = codecs.load(table)
    arm = SimulatedArm(table)
    for vector in edition.vectors:
        if vector.direction != "request":
            continue
        assert vector.frame is not None
        reply = arm.receive(vector.frame)
        _assert_remembered(arm, table, vector, codec.decode("request", vector.frame).fields)
        if table.command(vector.command).requires_reply:
            message = codec.decode("reply", reply, of=vector.command)
            given_values = dict(zip((n for n, _ in vector.values), _values(edition, vector)))
            for field in message.variant.fields:
                if field.echo:
                    assert message.fields[field.name] == given_values[field.name]
        elif reply:
            [frame] = codec.framer("reply").feed(reply)
            assert isinstance(frame, Frame)
            message = codec.decode("reply", frame.data, of=vector.command)
            assert message.command.ack
            assert message.command.refusal(message.fields) is None


def _assert_remembered(
    arm: SimulatedArm, table: Any, vector: Any, given_values: dict[str, Any]
) -> None:
    """Check that the arm has stored what the request sets."""
    effect = effect_of(table.command(vector.command))
    if isinstance(effect, Stores):
        [(argument, state)] = effect.values.items()
        assert arm.state.kept[state] == given_values[argument]


def _sent(generated: ModuleType, name: str, given_values: dict[str, Any]) -> bytes:
    """Return what a call sends; nothing if it raises the error of a wrong call."""
    peer, clock = MemoryPeer(), SteppedClock()
    with generated.CLIENT(
        MemoryTransport(peer, clock), on_error="leave", retry=RetryPolicy(attempts=1)
    ) as arm:
        with suppress(TypeError, UsageError, ReplyTimeout):
            getattr(arm, name)(**given_values)
    return peer.received


def arguments(variant: Variant) -> list[Field]:
    return [field for field in variant if field.const is None and not field.counts]


def _chosen(command: Command, names: set[str]) -> list[Variant]:
    """Return the variants that take exactly these arguments, by the rule of the language."""
    return [
        variant
        for variant in command.requests
        if {f.name for f in arguments(variant) if f.default is None} <= names
        and names <= {f.name for f in arguments(variant)}
    ]


def _exact(field: Field, values: dict[str, object]) -> object:
    if field.const is not None:
        assert not isinstance(field.type, Value)
        return field.type.from_raw(field.const)
    if field.name in values:
        return values[field.name]
    found = [part.from_raw(raw) for raw, (_, part) in zip(field.default or (), field.type.parts)]
    return tuple(found) if isinstance(field.type, Value) else found[0]


@settings(EXAMPLES, max_examples=15)
@given(st.data())
def test_arguments_choose_a_variant_and_other_combinations_send_nothing(
    tmp_path: Path, data: st.DataObject
) -> None:
    _, edition = data.draw(random_specs.specs(tmp_path))
    check(edition)
    generated = package(tmp_path, edition)
    codec = codecs.load(generated.TABLE)
    for command in edition.commands:
        # A legal value of each argument, exact and as in Python, by variant.
        legal: dict[int, dict[str, tuple[object, Any]]] = {}
        for vector in edition.vectors:
            if (vector.command, vector.direction) == (command.name, "request"):
                pairs = zip(vector.values, _values(edition, vector))
                values = {name: (exact, value) for (name, exact), value in pairs}
                legal[_variant(edition, vector)] = values
        any_variant = {name: pair for values in legal.values() for name, pair in values.items()}
        if command.event:
            assert not hasattr(generated.CLIENT, command.name)
            continue
        for names in _subsets([*named_fields(command.requests)]):
            fitting = _chosen(command, names)
            values = legal[command.requests.index(fitting[0])] if fitting else any_variant
            sent = _sent(generated, command.name, {name: values[name][1] for name in names})
            if not fitting:
                assert sent == b"", names
                continue
            [variant] = fitting
            given_values = {name: values[name][0] for name in names}
            exact = {f.name: _exact(f, given_values) for f in variant if not f.counts}
            exact = counted(variant, exact)
            assert sent == build_frame(edition.frame, command, "request", exact), names
            fields = codec.decode("request", sent, of=command.name).fields
            assert all(fields[name] == values[name][1] for name in names)


def _subsets(names: list[str]) -> list[set[str]]:
    sizes = range(len(names) + 1)
    return [set(found) for size in sizes for found in itertools.combinations(names, size)]


def test_generated_code_passes_mypy_strict_and_is_formatted(
    tmp_path: Path, mypy_cache: str
) -> None:
    """Check several protocols at once, since starting mypy takes longer than checking them."""

    @settings(EXAMPLES, max_examples=15)
    @given(st.data())
    def generate(data: st.DataObject) -> None:
        _, edition = data.draw(random_specs.specs(tmp_path))
        write(Target(tmp_path / "made" / f"rnd{next(NUMBERS)}", render_python(edition)))

    generate()
    for command in (
        ("mypy", "--strict", "--no-error-summary", mypy_cache, "made"),
        ("ruff", "format", "--check", "--isolated", "--line-length", "100", "made"),
    ):
        result = subprocess.run(
            [sys.executable, "-m", *command],
            capture_output=True,
            text=True,
            check=False,
            cwd=tmp_path,
        )
        assert result.returncode == 0, result.stdout + result.stderr
