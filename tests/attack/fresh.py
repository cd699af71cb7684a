"""Run the users of a plan in a fresh process, so that its first calls are attacked, too."""

from __future__ import annotations

import base64
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from attack.plans import Plan
from attack.record import Record
from attack.setting import Setting
from attack.users import run_threads

TESTS = Path(__file__).parents[1]
# The time that the process needs besides the run: to start, import and end.
START_SECONDS = 5.0


def run_fresh(setting: Setting, settle: Callable[[], None]) -> str:
    """Run the users in a new process, and take over its record.

    ``settle`` waits until the written bytes have arrived.

    Returns:
        A description of the failure of the process; empty if it succeeded.
    """
    work = base64.b64encode(pickle.dumps((setting.plan, setting.url))).decode()
    longest = START_SECONDS + setting.plan.seconds + setting.longest
    process = subprocess.Popen(
        [sys.executable, "-X", "faulthandler", "-m", "attack.fresh", work],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=TESTS,
    )
    try:
        written, errors = process.communicate(timeout=longest)
    except subprocess.TimeoutExpired:
        # After this signal the process prints where each thread is.
        process.send_signal(signal.SIGABRT)
        return f"the process hung for {longest:.1f} s\n{process.communicate()[1].decode()}"
    if process.returncode:
        return f"the process ended with code {process.returncode}\n{errors.decode()}"
    record = setting.record
    record.calls, record.handed, record.taken, record.bytes_taken = pickle.loads(written)
    settle()
    return ""


def main() -> None:
    """Run the users of the plan in the first argument; write the record to standard output."""
    plan: Plan
    plan, url = pickle.loads(base64.b64decode(sys.argv[1]))
    setting = Setting(plan, url)

    def during(shared: object) -> None:
        until = time.monotonic() + plan.seconds
        while not setting.over and time.monotonic() < until:
            time.sleep(0.005)
        setting.over = True

    # A TCP connection that is closed with unread bytes loses the bytes that were written last.
    run_threads(setting, during, lambda: time.sleep(0.1 * plan.tcp))
    record: Record = setting.record
    found = (record.calls, record.handed, record.taken, record.bytes_taken)
    sys.stdout.buffer.write(pickle.dumps(found))


if __name__ == "__main__":
    main()
