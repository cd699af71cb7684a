"""Run the referee with independent clients: in plain Python, and in C."""

from __future__ import annotations

import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from urllib.parse import urlsplit

from cobotwire.cli.conform_client import read_script
from cobotwire.conformance import Report
from cobotwire.conformance.client import Referee, faulty_replies
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import TcpServer
from defects.devices import built
from stalls import unstalled

HERE = Path(__file__).parent / "client"
DELAY, EVERY = 0.008, 3
# After this time without a request, everything that a client has sent has arrived; in seconds.
SETTLED, LONGEST = 0.15, 60.0
# A reply takes 8 ms, and a client waits 170 ms for it; in seconds.
ALLOWED_STALL = 0.1


def report_on_client(subject: str, defect: str = "", line: str = "") -> Report:
    """Test a client; repeat the session if the machine stood still, which falsifies its times."""
    if subject == "c_client":
        command, calls = [str(built(HERE / "client.c", defect)), "PORT"], HERE / "calls_c.txt"
    else:
        switch = [defect] if defect else []
        command, calls = (
            [sys.executable, str(HERE / "plain.py"), "PORT", *switch],
            HERE / "calls.txt",
        )
    return unstalled(partial(_session, command, calls, line), ALLOWED_STALL)


def _session(command: list[str], calls: Path, line: str) -> Report:
    referee = Referee(
        TABLE,
        scenario=faulty_replies(DELAY, [line] if line else [], EVERY),
        script=list(read_script(TABLE, calls.read_text("utf-8"), calls.name)),
    )
    with TcpServer(lambda: referee) as server:
        port = str(urlsplit(server.url).port)
        command = [port if word == "PORT" else word for word in command]
        subprocess.run(command, stderr=subprocess.DEVNULL, timeout=LONGEST, check=False)
        while (referee.silence or 0.0) < SETTLED:
            time.sleep(SETTLED / 3)
    return referee.finish()
