"""The rewritten program handles results and arms as the original one does, or the difference is
listed."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

from cobotwire import MyCobot280
from cobotwire.pymycobot.migrate import migrate
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from layer_comparison import Recorded, layer_on

HEAD = "from pymycobot import MyCobot280\n"
OPENED = "mc = MyCobot280(port)\n"
ROW = "[1, 2, 3, 4, 5, 6]"

# The result of a request without a reply, which only the library has.
LISTED = [
    f"ok = mc.send_angles({ROW}, 50)\nif ok == 1:\n    mc.set_color(1, 2, 3)",
    f"if mc.send_angles({ROW}, 50):\n    mc.set_color(1, 2, 3)",
    f"if not mc.send_angles({ROW}, 50):\n    mc.stop()",
    "while mc.power_on() != 1:\n    pass",
    "if mc.set_color(1, 2, 3) == -1:\n    mc.stop()",
    "if mc.stop() is None:\n    mc.set_color(1, 2, 3)",
    "print(mc.set_color(1, 2, 3))",
    "out.append(mc.stop())",
    "mc.stop() and mc.set_color(1, 2, 3)",
    "sent = [mc.set_color(0, 0, each) for each in range(3)]",
    "def send():\n    return mc.stop()\nif send():\n    mc.set_color(1, 2, 3)",
    "run = lambda: mc.stop()\nif run():\n    mc.set_color(1, 2, 3)",
    "class Robot:\n    ok = 0\nRobot.ok = mc.stop()\nif Robot.ok:\n    mc.power_off()",
    "a, b = mc.stop(), mc.set_color(1, 2, 3)\nif a:\n    mc.stop()",
    "if (ok := mc.stop()):\n    mc.set_color(1, 2, 3)",
    "assert mc.stop()",
    "out.append('%s' % mc.stop())",
    "ok = done = mc.stop()\nif done:\n    mc.set_color(1, 2, 3)",
    f"ok = mc.sync_send_angles({ROW}, 50)\nout.append(ok)",
    "ok = mc.go_home()\nout.append(ok)",
    # A test whether a call failed.
    "if mc.get_angles() == -1:\n    mc.stop()",
    "if mc.get_angles() is None:\n    mc.stop()",
    "row = mc.get_angles()\nif row == []:\n    mc.stop()",
    "row = mc.get_angles()\nif not row:\n    mc.stop()",
    "row = mc.get_angles()\nif isinstance(row, int):\n    mc.stop()",
    "row = mc.get_angles()\nif type(row) == int:\n    mc.stop()",
    "row = mc.get_angles()\nif len(row) != 6:\n    mc.stop()",
    "row = mc.get_angles()\nwhile row in (-1, None):\n    row = mc.get_angles()",
    "if mc.get_gripper_value() < 0:\n    mc.stop()",
    "def read():\n    return mc.get_angles()\nif read() == -1:\n    mc.stop()",
    "def check(row):\n    if row is None:\n        mc.stop()\ncheck(mc.get_angles())",
    "class Robot:\n    def __init__(self):\n        self.row = mc.get_angles()\n"
    "        if self.row is None:\n            mc.stop()\nRobot()",
    # Uses of an arm in which migrate cannot find the calls.
    "getattr(mc, 'stop')()",
    "stop = mc.stop\nstop()",
    "mc.debug = True",
    "arms = [mc]\narms[0].stop()",
    "arms = {'left': mc}\narms['left'].stop()",
    "for each in [mc]:\n    each.stop()",
    "first, count = mc, 1\n[first, count] = [mc, 2]\nlist(map(lambda each: each.stop(), [mc]))",
    "given = ([0] * 6, 50)\nmc.send_angles(*given)",
    "given = {'speed': 50}\nmc.send_angles([0] * 6, **given)",
    "exec('mc.stop()')",
    "class Mine(MyCobot280):\n    def halt(self):\n        return self.stop()",
    "speed = mc.no_such_attribute if False else 50",
    "int = float\nout.append(mc.is_power_on())",
    "mc = out\nmc.append(1)",
]
# Programs that do the same, unchanged or with a conversion of the result.
SAME = [
    "row = mc.get_angles()\nrow.append(7)\nout.append(row)",
    "row = mc.get_angles()\nrow[0] = 7\nout.append(row)",
    "row = mc.get_angles()\nrow[0] += 7\nout.append(row)",
    "row = mc.get_angles()\nrow.sort()\nout.append(row)",
    "row = mc.get_angles()\nrow += [7]\nout.append(row)",
    "row = mc.get_angles()\ndel row[0]\nout.append(row)",
    "row = mc.get_angles()\nother = row\nother.append(7)\nout.append(row)",
    "row = mc.get_angles()\nout.append(row + [7])",
    "row = mc.get_angles()\nout.append(row[:3])",
    "row = mc.get_angles()\nout.append(row == [0, 0, 0, 0, 0, 0])",
    "row = mc.get_angles()\nout.append([0.0] * 6 == row)",
    "import json\nout.append(json.dumps(mc.is_power_on()))",
    "out.append(f'{mc.get_angles()} {mc.is_power_on()}')",
    "def change(row):\n    row.append(7)\n    return row\nout.append(change(mc.get_angles()))",
    "def read():\n    return mc.get_angles()\nout.append(read())",
    "class Robot:\n    def __init__(self):\n        self.row = mc.get_angles()\n"
    "out.append(Robot().row)",
    "rows = {'now': mc.get_angles()}\nout.append(rows)",
    "j1, j2, *rest = mc.get_angles()\nout.append(rest)",
    "row = mc.get_angles()\nmc.send_angles(row, 50)",
    "row = mc.get_angles()\nrow[0], row[1] = 1, 2\nout.append(row)",
    "for row[0] in (1, 2):\n    pass".replace("for", "row = mc.get_angles()\nfor")
    + "\nout.append(row)",
    "out.append(mc.is_power_on())",
    "out.append(mc.is_power_on() is True)",
    "out.append([mc.is_power_on()])",
    "if mc.is_power_on() == 1:\n    mc.set_color(1, 2, 3)",
    "if not mc.is_moving():\n    mc.set_color(1, 2, 3)",
    "out.append(mc.is_power_on() + 1)",
    "out.append(mc.get_end_type())",
    "out.append(max(mc.get_angles()))",
    "out.append([each for each in mc.get_coords()])",
    "ok = mc.set_color(1, 2, 3)",
    "def use(robot):\n    robot.set_color(r=1, g=2, b=3)\nuse(mc)",
    "def opened():\n    return MyCobot280(port)\nother = opened()\nother.set_color(b=3)",
    "class Robot:\n    def __init__(self, arm):\n        self.arm = arm\n    def run(self):\n"
    "        self.arm.set_color(b=3)\nRobot(mc).run()",
    "class Kept:\n    stop = MyCobot280 = 1\nmc.set_color(b=Kept.MyCobot280)",
    "MyCobot280(port).set_color(b=3)",
]


def seen(text: str, client: Any) -> tuple[bytes, list[Any]]:
    """Run a program; return what it sent, and what it appended to ``out``."""
    clock, out = SteppedClock(), list[Any]()
    transport = Recorded(SimulatedArm(MyCobot280.table, clock=clock, powered=True), clock)
    arm = client(transport)
    transport.written = b""
    exec(text, {"port": "", "out": out, "MyCobot280": lambda *_: arm, "__name__": "program"})
    return transport.written, out


@pytest.mark.parametrize("program", LISTED)
def test_program_that_may_differ_is_listed(program: str) -> None:
    assert migrate(f"{HEAD}{OPENED}{program}\n").decisions


@pytest.mark.parametrize("program", SAME)
def test_program_without_decision_does_the_same(program: str) -> None:
    found = migrate(f"{HEAD}{OPENED}{program}\n")
    assert found.decisions == ()
    imports, _, rewritten = found.text.partition("from cobotwire import MyCobot280\n")
    assert imports == ""
    theirs, ours = (
        seen(OPENED + program, partial(layer_on, "MyCobot280")),
        seen(rewritten, MyCobot280),
    )
    assert (ours, repr(ours)) == (theirs, repr(theirs))
