"""Programs of the maker's library run unchanged on the layer, over a pseudo-terminal."""

from __future__ import annotations

import inspect
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import version as pymycobot_version
from pathlib import Path

import pytest

import cobotwire.pymycobot as ours
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.pymycobot.layer.absent import OTHERS
from cobotwire.pymycobot.migrate import migrate
from cobotwire.pymycobot.running import as_library
from cobotwire.session import RequestReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, SimulatedArm
from command_line import PROGRAM, run_program

PAGE = Path(__file__).parents[2] / "docs" / "pymycobot.md"
TYPICAL = Path(__file__).parent / "programs" / "typical.py"


class Served:
    """A simulated arm on a pseudo-terminal, and the names of the requests that it received."""

    def __init__(self) -> None:
        self.received: list[str] = []
        self.arm = SimulatedArm(TABLE, on_event=self._note)

    def _note(self, event: DeviceEvent, reply: bytes) -> None:
        if isinstance(event, RequestReceived):
            self.received.append(event.message.command.name)


@pytest.fixture
def served() -> Iterator[tuple[Served, str]]:
    found = Served()
    with PtyServer(found.arm) as server:
        yield found, server.url


def test_program_runs_unchanged(served: tuple[Served, str]) -> None:
    arm, port = served
    ended = run_program("run", TYPICAL, port)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.splitlines() == [
        "angles [20, 10, 0, 0, 0, 0]",
        "powered 1 version 6.5",
        "axis 4 ports list",
        "rejected",
    ]
    assert arm.received[:4] == ["power_on", "set_color", "send_angles", "send_angle"]
    assert arm.received.count("stop") == 1


def test_python_m_runs_a_program_like_cobotwire_run(served: tuple[Served, str]) -> None:
    _, port = served
    command = [sys.executable, "-m", "cobotwire.pymycobot", str(TYPICAL), port]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "rejected" in ended.stdout


def test_failing_program_stops_its_arm_and_shows_its_own_traceback(
    served: tuple[Served, str],
) -> None:
    arm, port = served
    ended = run_program("run", TYPICAL, port, "fail")
    assert ended.returncode == 1
    lines = ended.stderr.splitlines()
    assert lines[1].startswith(f'  File "{TYPICAL}", line ')
    assert lines[-1] == "RuntimeError: a mistake in the program"
    assert arm.received[-1] == "stop"


def test_ctrl_c_stops_the_arm_once(served: tuple[Served, str]) -> None:
    arm, port = served
    with subprocess.Popen(
        [*PROGRAM, "run", str(TYPICAL), port, "forever"],
        stdout=subprocess.PIPE,
        text=True,
        # If the tests run in the background, SIGINT is ignored, and child processes inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    ) as program:
        assert program.stdout is not None
        assert any(line == "moving\n" for line in program.stdout)
        before = arm.received.count("stop")
        program.send_signal(signal.SIGINT)
        assert program.wait(30) == 130
    assert arm.received.count("stop") == before + 1


def test_program_imports_from_its_folder_and_its_threads_keep_the_arm_open(
    served: tuple[Served, str], tmp_path: Path
) -> None:
    arm, port = served
    (tmp_path / "port_setup.py").write_text("SECONDS = 1\n")
    script = tmp_path / "threads.py"
    script.write_text(
        "import sys, threading, time\n"
        "from port_setup import SECONDS\n"
        "from pymycobot import MyCobot280\n"
        "mc = MyCobot280(sys.argv[1])\n"
        "def later():\n"
        "    time.sleep(SECONDS)\n"
        "    mc.get_angles()\n"
        "    print('read')\n"
        "threading.Thread(target=later).start()\n"
    )
    ended = run_program("run", script, port)
    assert (ended.returncode, ended.stderr, ended.stdout) == (0, "", "read\n")
    assert arm.received.count("get_angles") == 1


FAILING = {
    "arm out of scope": "move()\nraise RuntimeError\n",
    "exit code": "mc = move()\nsys.exit('failed')\n",
    "thread": (
        "def work():\n    mc = move()\n    raise RuntimeError\n"
        "thread = threading.Thread(target=work)\nthread.start()\nthread.join()\n"
    ),
}
MOVING = (
    "import sys, threading\n"
    "from pymycobot import MyCobot280\n"
    "def move():\n"
    "    mc = MyCobot280(sys.argv[1])\n"
    "    mc.send_angles([90, 0, 0, 0, 0, 0], 1)\n"
    "    return mc\n"
)


@pytest.mark.parametrize("end", FAILING)
def test_arm_is_stopped_once_however_its_program_fails(
    served: tuple[Served, str], tmp_path: Path, end: str
) -> None:
    arm, port = served
    script = tmp_path / "failing.py"
    script.write_text(MOVING + FAILING[end])
    assert run_program("run", script, port).returncode == 1
    assert arm.received.count("send_angles") == arm.received.count("stop") == 1


def test_port_of_an_arm_out_of_scope_can_be_opened_again(
    served: tuple[Served, str], tmp_path: Path
) -> None:
    arm, port = served
    script = tmp_path / "again.py"
    script.write_text(MOVING + "move()\nmove()\nsys.exit(0)\n")
    ended = run_program("run", script, port)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert (arm.received.count("send_angles"), arm.received.count("stop")) == (2, 0)


def test_missing_program_and_missing_module_are_named(tmp_path: Path) -> None:
    ended = run_program("run", tmp_path / "none.py")
    assert ended.returncode == 2
    assert ended.stderr == f"cobotwire: {tmp_path / 'none.py'}: no such file\n"
    other = tmp_path / "other.py"
    other.write_text("from pymycobot.ultraArm import ultraArm\n")
    ended = run_program("run", other)
    assert ended.returncode == 1
    assert "cobotwire has no pymycobot.ultraArm: these robots take G-code" in ended.stderr


# pymycobot reads the locale in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_every_class_that_is_not_offered_is_refused_with_its_reason() -> None:
    import pymycobot

    for name in set(pymycobot.__all__) - set(ours.__all__):
        module = f"pymycobot.{Path(inspect.getfile(getattr(pymycobot, name))).stem}"
        [decision] = migrate(f"from pymycobot import {name}\n").decisions
        why = decision.what.removeprefix(f"cobotwire has no {name}: ")
        assert why in OTHERS.values()
        assert why in PAGE.read_text("utf-8")
        for source in ("cobotwire.pymycobot", "pymycobot", module):
            absent = module if source is module else name
            text = re.escape(f"cobotwire has no {absent}: {why}")
            with as_library(), pytest.raises(ImportError, match=text):
                exec(f"from {source} import {name}", {})


# pymycobot reads the locale in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_installed_library_is_the_same_before_and_after() -> None:
    import pymycobot

    with as_library():
        import pymycobot as inside

        assert inside.MyCobot280.__module__ == "cobotwire.pymycobot.mycobot280"
    assert sys.modules["pymycobot"] is pymycobot
    assert pymycobot.MyCobot280.__module__ == "pymycobot.mycobot280"


def test_traceback_of_our_error_shows_only_lines_of_the_program(tmp_path: Path) -> None:
    script = tmp_path / "absent_port.py"
    script.write_text(
        "import pymycobot\n"
        "print(pymycobot.__version__)\n"
        "pymycobot.MyCobot280('/dev/no-such-port')\n"
    )
    ended = run_program("run", script)
    assert (ended.returncode, ended.stdout) == (1, f"{pymycobot_version('pymycobot')}\n")
    lines = ended.stderr.splitlines()
    assert [line.startswith("  File") for line in lines].count(True) == 1
    assert "/dev/no-such-port: cannot be opened: No such file" in lines[-1]


def test_program_reads_why_a_name_has_no_counterpart(
    served: tuple[Served, str], tmp_path: Path
) -> None:
    _, port = served
    script = tmp_path / "absent.py"
    script.write_text(
        "import sys\nfrom pymycobot import MyCobot280\nMyCobot280(sys.argv[1]).crc_check([1])\n"
    )
    ended = run_program("run", script, port)
    assert ended.returncode == 1
    assert "'crc_check': They concern the library itself" in ended.stderr
