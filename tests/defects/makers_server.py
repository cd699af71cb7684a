"""The maker's server between the tester and a correct arm: the firmware in C on its pty.

The server is a program of the maker's repository, which is fetched for the run.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from cobotwire.conformance import Report
from cobotwire.editions.mycobot import TABLE
from cobotwire.transport import open_transport
from defects.devices import firmware, report_on

REPOSITORY = "https://github.com/elephantrobotics/pymycobot"
COMMIT = "44d7fb1"
SERVER = "demo/Server_280.py"
START = """import sys
from Server_280 import MycobotServer
MycobotServer("127.0.0.1", int(sys.argv[1]), sys.argv[2], 115200)
"""
# The server accepts only one connection, so a test connection would use it up.
START_SECONDS = 2.0
BY_DEFECT: dict[str, tuple[str, ...]] = {
    "drops-text": (),
    "dies-on-short-writes": ("malformed",),
}


def report_on_server(defect: str = "") -> Report:
    """Test the server with the permissions that show one of its defects."""
    with _firmware() as port, _serving(port) as url:
        transport = open_transport(url, TABLE.baudrate)
        try:
            return report_on(transport, BY_DEFECT[defect])
        finally:
            transport.close()


@contextmanager
def _firmware() -> Iterator[str]:
    """Run the correct firmware while the block runs; return its port."""
    program = [str(firmware())]
    with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield process.stdout.readline().strip()
        finally:
            process.kill()


@contextmanager
def _serving(port: str) -> Iterator[str]:
    """Run the server between its clients and a port while the block runs."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "Server_280.py").write_text(_source(), "utf-8")
        # The library for the pins of its computer is not installed here.
        (folder / "RPi").mkdir()
        (folder / "RPi" / "GPIO.py").write_text("def setwarnings(on): pass\n")
        number = _free_port()
        command = [sys.executable, "-c", START, str(number), port]
        with subprocess.Popen(
            command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as server:
            try:
                time.sleep(START_SECONDS)
                yield f"socket://127.0.0.1:{number}"
            finally:
                server.kill()


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port: int = server.getsockname()[1]
        return port


@cache
def _source() -> str:
    """Return the server's source, as the maker publishes it."""
    repository = os.environ.get("MAKERS_REPOSITORY", REPOSITORY)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["git", "clone", "--quiet", "--bare", repository, folder], check=True)
        shown = ["git", "-C", folder, "show", f"{COMMIT}:{SERVER}"]
        return subprocess.run(shown, check=True, capture_output=True, text=True).stdout
