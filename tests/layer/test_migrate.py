"""Programs of the maker's library are rewritten for our clients."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cobotwire.cli.app import app
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.migrate import migrate
from cobotwire.pymycobot.migrate.calls import library
from cobotwire.simulator import PtyServer, SimulatedArm
from in_process import run

TYPICAL = Path(__file__).parent / "programs" / "typical.py"
HEAD = "from pymycobot import MyCobot280\nmc = MyCobot280(port)\n"
OURS = "from cobotwire import MyCobot280\nmc = MyCobot280(port)\n"


def rewritten(line: str) -> str:
    found = migrate(HEAD + line + "\n")
    assert found.decisions == ()
    head, ours, rest = found.text.replace("import time\n\n", "").partition(OURS)
    assert (head, ours) == ("", OURS)
    return rest.rstrip("\n")


def decided(line: str) -> list[str]:
    return [str(each) for each in migrate(HEAD + line + "\n").decisions]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("mc.send_angle(1, 20, 30)", "mc.send_angle(1, 20, 30)"),
        ("mc.send_angle(id=1, degree=20, speed=30)", "mc.send_angle(joint=1, angle=20, speed=30)"),
        ("mc.send_angle(1, speed=30, degree=20)", "mc.send_angle(1, angle=20, speed=30)"),
        ("mc.send_angles(row, 30, _async=True)", "mc.send_angles(row, 30)"),
        ("mc.send_angles(row, 30, True)", "mc.send_angles(row, 30)"),
        ("mc.send_coords(row, 30, 1)", "mc.send_coords(row, 30, 1)"),
        ("mc.is_in_position(row)", "mc.is_in_position(row)"),
        ("mc.is_in_position(row, id=1)", "mc.is_in_position(row, kind=1)"),
        ("mc.set_color(g=255)", "mc.set_color(green=255)"),
        ("mc.sync_send_angles(row, 50)", "mc.move_angles(row, 50, timeout=15)"),
        ("mc.sync_send_coords(row, 50, timeout=3)", "mc.move_coords(row, 50, 0, timeout=3)"),
        ("mc.go_home()", "mc.send_angles([0] * 6, 10)"),
        ("mc.gripper_stop()", "mc.set_gripper_value(0, 0, 1, 1)"),
        ("mc.wait(2)", "time.sleep(2)"),
        ("row = mc.get_angles()\nprint(row)", "row = list(mc.get_angles())\nprint(row)"),
        ("row = mc.get_angles()\nprint(row[0])", "row = mc.get_angles()\nprint(row[0])"),
        ("row = mc.get_angles()\nrow[0] += 5", "row = list(mc.get_angles())\nrow[0] += 5"),
        ("row = mc.get_coords()\nrow.append(1)", "row = list(mc.get_coords())\nrow.append(1)"),
        ("other = mc\nother.focus_servo(servo_id=1)", "other = mc\nother.focus_servo(joint=1)"),
    ],
)
def test_call_is_rewritten(before: str, after: str) -> None:
    assert rewritten(before) == after


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("MyCobot280(port, 115200)", "MyCobot280(port, 115200)"),
        ("MyCobot280(port, '1000000')", "MyCobot280(port, 1000000)"),
        ("MyCobot280(port, baudrate=speed)", "MyCobot280(port, int(speed))"),
        ("MyCobot280(port, args.baud, debug=True)", "MyCobot280(port, int(args.baud))"),
        ("MyCobot280Socket('10.0.0.2', 9000)", 'MyCobot280("socket://10.0.0.2:9000")'),
        ("MyCobot280Socket('10.0.0.2', '9000')", 'MyCobot280("socket://10.0.0.2:9000")'),
        ('MyCobot280Socket(at["ip"])', "MyCobot280(f'socket://{at[\"ip\"]}:9000')"),
        ("MyCobot280Socket(host)", 'MyCobot280(f"socket://{host}:9000")'),
    ],
)
def test_constructor_is_rewritten(before: str, after: str) -> None:
    head = "from pymycobot import MyCobot280, MyCobot280Socket\n"
    found = migrate(f"{head}mc = {before}\n")
    assert found.text == f"from cobotwire import MyCobot280\nmc = {after}\n"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("if mc.get_angles() == -1: pass", "3:4: a call that fails raises ReplyTimeout"),
        ("row = mc.get_angles()\nif row is None: pass", "4:4: a call that fails raises"),
        ("print(mc.get_radians())", "3:7: our result is not rounded"),
        ("mc.gpio_init()", "3:1: our clients drive no pins"),
        ("mc.wait(1).stop()", "3:1: write time.sleep(seconds) in a line of its own"),
        ("mc.send_angles(*given)", "3:1: the arguments are not known here"),
        ("mc.no_such_method()", "3:1: MyCobot280 has no counterpart of no_such_method"),
        ("robot.send_angles(row, 50)", "3:1: robot may be an arm"),
        ("def test(it): it.send_angles(row, 50)", "3:10: it may be an arm, whose class is not"),
        (
            "from pymycobot import ultraArm",
            "3:1: cobotwire has no ultraArm: these robots take G-code",
        ),
        ("import pymycobot", "3:1: names of `import pymycobot` are not rewritten"),
        ("other = MyCobot280(port, timeout=1)", "3:9: timeout was the time of one read"),
    ],
)
def test_places_that_a_person_must_decide_are_listed(line: str, says: str) -> None:
    found = decided(line)
    assert any(each.startswith(says) for each in found), found


@pytest.mark.parametrize("name", sorted(library()))
def test_constructor_opens_what_the_library_opens_by_default(name: str) -> None:
    kind = library()[name]
    place, number = (kind.default(each) for each in kind.constructor[:2])
    given = "" if place else "'at'"
    found = migrate(f"from pymycobot import {name}\nmc = {name}({given})\n").text
    opened = found.partition("mc = ")[2].strip()
    if kind.opens == "socket":
        assert opened == f'{kind.native}("socket://{place or "at"}:{number}")'
    else:
        assert str(place or "at") in opened
        assert str(number) == str(kind.usual) or str(number) in opened


# The library's class and ours; calls, what they become, and a part of the decision if there is one.
OF_CLASSES = """
MyCobot280RDKX5, MyCobot280RDKX5
    get_gripper_value() -> get_gripper_value(1)
MyBuddy, MyBuddy
    get_angles(1) -> left.get_angles()
    send_angle(2, 1, 30, 50) -> right.send_angle(1, 30, 50)
    send_angle(3, joint=1, angle=30, speed=50) -> waist.send_angle(joint=1, angle=30, speed=50)
    power_on() -> power_on()
    stop(0) -> all.stop()
    set_tool_color(side, 255, 0, 0) -> at(side).set_color(255, 0, 0)
    sync_send_angles(1, row, 50) -> left.move_angles(row, 50, timeout=15)
    get_base_coords() -> get_base_coords()
    set_encoders(1, row, pace) -> left.set_encoders(row, speed=pace) -> if this is a list
MyCobot, MyCobot280
    sync_send_angles(row, 50) -> move_angles(row, 50, timeout=30)
    go_home() -> send_angles([0] * 6, 10)
MechArm, MechArm270
    release_servo(1) -> release_servo(1)
MyPalletizer, MyPalletizer260
    send_coords(row, 50) -> send_coords(row, 50)
Mercury, MercuryA1
    set_pro_gripper_angle(50) -> set_pro_gripper(11, 50) -> on a body, write MercuryB1
    get_hand_gripper_p(3, gripper_id=15) -> get_hand_gripper(16, 3, gripper=15) -> write MercuryB1
    send_angles(row, 50) -> send_angles(row, 50) -> use move_angles or move_coords
    go_home(2) -> go_home(2) -> go_home waits
"""


def of_classes() -> Iterator[list[str]]:
    """Yield the library's class, ours, the call before and after, and what must be decided."""
    names: list[str] = []
    for line in OF_CLASSES.strip().splitlines():
        if line.startswith(" "):
            yield [*names, *f"{line.strip()} -> ".split(" -> ")[:3]]
        else:
            names = line.split(", ")


@pytest.mark.parametrize(("name", "ours", "before", "after", "says"), [*of_classes()])
def test_call_of_another_class_is_rewritten(
    name: str, ours: str, before: str, after: str, says: str
) -> None:
    head = "from {} import {}\narm = {}(port)\n"
    found = migrate(f"{head.format('pymycobot', name, name)}arm.{before}\n")
    assert found.text == f"{head.format('cobotwire', ours, ours)}arm.{after}\n"
    assert any(says in str(each) for each in found.decisions) if says else not found.decisions


@pytest.mark.parametrize("module", ["pymycobot", "pymycobot.myarm"])
def test_class_with_another_name_is_imported_under_ours(module: str) -> None:
    found = migrate(f"from {module} import MyArm\nmc = MyArm(port)\n")
    assert found == ("from cobotwire import MyArm300\nmc = MyArm300(port)\n", ())


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (
            "from pymycobot import MyArmSocket as Arm\nmc = Arm(host)",
            'from cobotwire import MyArm300 as Arm\nmc = Arm(f"socket://{host}:9000")',
        ),
        (
            "from pymycobot import MyArm\nkind = MyArm\nmc = kind(port, '115200')",
            "from cobotwire import MyArm300\nkind = MyArm300\nmc = kind(port, 115200)",
        ),
    ],
)
def test_alias_of_a_class_in_the_program_is_kept(before: str, after: str) -> None:
    found = migrate(f"{before}\nmc.focus_servo(servo_id=1)\n")
    assert found == (f"{after}\nmc.focus_servo(joint=1)\n", ())


def test_name_of_several_classes_is_a_decision() -> None:
    head = "from pymycobot import MyArm, MyCobot280\nkind = MyArm\nif old:\n    kind = MyCobot280\n"
    [decision] = migrate(f"{head}mc = kind(port, '115200')\n").decisions
    assert str(decision).startswith("5:6: kind stands for several classes")


def test_home_of_a_socket_class_waits() -> None:
    head = "from pymycobot import MyCobotSocket\nmc = MyCobotSocket('10.0.0.2')\n"
    found = migrate(f"{head}mc.go_home()\n").text
    assert found.endswith("mc.move_angles([0] * 6, 30)\n")


def test_reason_of_absent_name_is_listed() -> None:
    head = "from pymycobot import MyBuddy\nmb = MyBuddy(port)\n"
    [decision] = migrate(f"{head}mb.set_color(1, 2, 3)\n").decisions
    assert "set_color: The library puts the first argument in the place" in decision.what
    [decision] = migrate(f"{head}mb.set_gpio_output(1, 1)\n").decisions
    assert decision.what.startswith("our clients drive no pins of this computer")


UNDECIDED = """\
row = mc.get_angles()
if row == -1 or not row:
    row[0] += 5
powered = mc.is_power_on()
if powered is None or powered == -1:
    mc.gpio_init()
print(mc.is_power_on(), mc.get_radians(), mc.go_home())
ok = mc.send_angles(row, 50)
if ok == 1: pass
arms = {"left": mc}
"""


def test_rewritten_program_is_not_changed_again_and_has_the_same_undecided_places() -> None:
    first = migrate(HEAD + UNDECIDED)
    again = migrate(first.text)
    assert again.text == first.text
    assert [(each.line, each.what) for each in again.decisions] == [
        (each.line, each.what) for each in first.decisions
    ]
    assert len(first.decisions) == 9


@pytest.mark.parametrize("rewritten_before", [False, True])
def test_unknown_class_of_a_parameter_is_one_decision_and_may_be_annotated_later(
    rewritten_before: bool,
) -> None:
    used = "    it.send_angle(id=1, degree=20, speed=30)\n    print(it.get_angles())\n"
    found = migrate(f"{HEAD}def test(it):\n{used}")
    [decision] = found.decisions
    assert "write `def test(it: MyCobot280)`" in decision.what
    text = found.text if rewritten_before else f"{HEAD}def test(it):\n{used}"
    done = migrate(text.replace("(it)", "(it: MyCobot280)"))
    assert done.decisions == ()
    assert "send_angle(joint=1, angle=20, speed=30)" in done.text
    assert "print(list(it.get_angles()))" in done.text


def test_devices_of_a_rewritten_program_are_not_changed_again() -> None:
    text = "from pymycobot import MyBuddy\nmb = MyBuddy(port)\nmb.send_angle(2, 1, 30, 50)\n"
    once = migrate(text)
    assert migrate(once.text) == once


def test_time_is_imported_where_it_is_needed() -> None:
    assert "\nimport time\n" in migrate(f"{HEAD}mc.wait(2)\n").text
    assert migrate(f"import time\n{HEAD}mc.wait(2)\n").text.count("import time") == 1


def test_other_programs_and_formatting_stay_as_they_are() -> None:
    text = "# A comment.\nimport   os\r\nx = [1,2]  # spaces\n\n\n\n"
    assert migrate(text) == (text, ())


def test_text_that_is_not_python_is_rejected_with_its_place() -> None:
    with pytest.raises(UsageError, match=r"old\.py:1:"):
        migrate("print 'hello'\n", "old.py")


def test_rewritten_program_runs_and_prints_the_same(tmp_path: Path) -> None:
    text = TYPICAL.read_text().replace("mc.wait(0.01).stop()", "mc.wait(0.01)\nmc.stop()")
    script = tmp_path / "program.py"
    script.write_text(text)
    ended = run(app, "cobotwire", "migrate", "--write", str(script))
    assert (ended.returncode, ended.stdout) == (0, f"wrote {script}\n")
    assert "from pymycobot" not in script.read_text()
    with PtyServer(SimulatedArm(TABLE)) as server:
        done = subprocess.run(
            [sys.executable, str(script), server.url], capture_output=True, text=True, timeout=60,
            check=False,
        )  # fmt: skip
    assert done.stderr == ""
    assert done.stdout.splitlines()[:1] == ["angles [20, 10, 0, 0, 0, 0]"]
    assert "powered 1 version 6.5" in done.stdout


def test_diff_is_shown_and_the_file_stays(tmp_path: Path) -> None:
    script = tmp_path / "program.py"
    script.write_text(HEAD + "mc.gpio_init()\n")
    ended = run(app, "cobotwire", "migrate", str(script))
    assert ended.returncode == 1
    assert "-from pymycobot import MyCobot280\n+from cobotwire import MyCobot280\n" in ended.stdout
    assert ended.stderr.startswith(f"{script}:3:1: our clients drive no pins")
    assert script.read_text().startswith("from pymycobot")


def test_json_has_text_and_decisions(tmp_path: Path) -> None:
    script = tmp_path / "program.py"
    script.write_text(HEAD + "mc.gpio_init()\n")
    ended = run(app, "cobotwire", "migrate", "--json", str(script))
    assert '"changed": true' in ended.stdout
    assert '"decisions": [{"line": 3, "column": 1, "what": ' in ended.stdout
