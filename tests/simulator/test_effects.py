"""Effects on a simulated arm: some that no shipped edition has, and rare cases of the others."""

from __future__ import annotations

import pytest

from cobotwire.editions.mercury_a1 import TABLE as MERCURY
from cobotwire.editions.mycobot280 import TABLE
from simulator.bench import Bench
from trial_specs import FOOTED, HEAD, package_of

SPEC = f"""{HEAD}joints: 2
{FOOTED}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
    word: {{bytes: 2, order: big, signed_at: 32767, doc: A signed word.}}
  quantities:
    number: {{wire: byte, doc: A number.}}
    slot: {{wire: byte, range: [0, 7], doc: A slot.}}
    angle: {{wire: word, scale: 1/10, unit: degree, doc: An angle.}}
state:
  tools: {{type: number, each: slot, start: 1}}
  speed: {{type: number, each: slot, start: 50}}
commands:
  power_on:
    {{id: 1, title: P, doc: P., safety: power, effect: {{sets: {{powered: true, held: true}}}}}}
  stop: {{id: 2, title: S, doc: S., safety: motion, role: stop}}
  set_tool:
    {{id: 3, title: T, doc: T., safety: setting, effect: {{stores: {{tool: tools}}, at: slot}},
      request: [{{name: slot, type: slot}}, {{name: tool, type: number}}]}}
  clear_tools: {{id: 4, title: T, doc: T., safety: setting, effect: {{sets: {{tools: 9}}}}}}
  get_tool:
    {{id: 5, title: T, doc: T., safety: query, effect: {{reports: tools, at: slot}},
      request: [{{name: slot, type: slot}}], reply: [{{name: tool, type: number}}]}}
  get_speed:
    {{id: 6, title: T, doc: T., safety: query, effect: {{reports: speed, at: slot}},
      request: [{{name: slot, type: slot}}], reply: [{{name: speed, type: number}}]}}
  turn:
    {{id: 7, title: T, doc: T., safety: motion, effect: {{moves: joint, at: axle, to: angle}},
      request: [{{name: axle, type: number}}, {{name: angle, type: angle}}]}}
  limit:
    {{id: 8, title: T, doc: T., safety: setting, effect: {{stores: {{angle: lowest}}, at: axle}},
      request: [{{name: axle, type: number}}, {{name: angle, type: angle}}]}}
  get_angle:
    {{id: 9, title: T, doc: T., safety: query, effect: {{reports: angles, at: axle}},
      request: [{{name: axle, type: number}}], reply: [{{name: angle, type: angle}}]}}
"""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    with package_of(SPEC, tmp_path_factory.mktemp("trial")) as package:
        return Bench(package.TABLE)


def test_value_for_every_index_replaces_each_of_them(bench: Bench) -> None:
    bench.send("set_tool", 0, 5)
    assert [bench.query("get_tool", slot) for slot in (0, 7)] == [5, 1]
    bench.send("clear_tools")
    bench.send("set_tool", 7, 6)
    assert [bench.query("get_tool", slot) for slot in (0, 3, 7)] == [9, 9, 6]


@pytest.mark.parametrize("axle", [0, 3, 255])
def test_joint_that_the_arm_lacks_is_rejected(bench: Bench, axle: int) -> None:
    bench.send("turn", axle, 10)
    assert bench.arm.notes[-1].text == f"rejected: the arm has no joint {axle}"
    bench.send("limit", axle, 5)
    assert bench.arm.notes[-1].text == f"rejected: the arm has no joint {axle}"
    assert b"no source says" in bench.send("get_angle", axle)
    assert not bench.arm.state.angles.moving(bench.clock())


def test_state_named_speed_of_another_type_does_not_hinder_a_motion(bench: Bench) -> None:
    bench.send("turn", 2, 10)
    bench.clock.sleep(60)
    assert (bench.query("get_angle", 2), bench.query("get_speed", 0)) == (10, 50)


def test_joint_254_clears_the_faults_of_every_joint() -> None:
    bench = Bench(MERCURY, powered=False)
    bench.arm.state.kept["servo_faults"] = {(1,): 1, (7,): 2}
    bench.send("servo_restore", 7)
    assert bench.query("get_servo_status") == (1, 0, 0, 0, 0, 0, 0)
    bench.send("servo_restore", 254)
    assert bench.query("get_servo_status") == (0,) * 7


def test_stored_text_that_no_reply_can_have_is_refused() -> None:
    bench = Bench(TABLE)
    bench.arm.receive(bench.send("set_ssid_pwd") + b"'a'(b\tc)")
    reply = bench.send("get_ssid_pwd") + bench.arm.flush()
    assert b"characters that a reply cannot have" in reply
    assert bench.arm.state.kept["password"] == "b\tc"
