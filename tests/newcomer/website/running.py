"""Run a page by its plan, in a folder of its own, with a simulated arm at its ports."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from docs.pages import SECONDS, output_pattern, run
from newcomer.website.blocks import commands, programs
from newcomer.website.planned import ANY, Expected, NotRun, Plan, Program

# What the pages name as the port of an arm.
PORT = re.compile(r"/dev/tty(?:ACM0|USB0)|socket://192\.168\.1\.(?:5|10):9000")
CHILD = """\
import json, sys
names = {"__name__": "__main__"}
for place, setup, text in json.load(open(sys.argv[1])):
    exec(compile(setup, f"before {place}", "exec"), names)
    exec(compile(text, place, "exec"), names)
    print("\\0", end="", flush=True)
"""


class Result(NamedTuple):
    """The result of a command or a program: whether it did what the page says."""

    what: str
    problem: str = ""
    # Why it was not run.
    reason: str = ""


def run_page(path: Path, plan: Plan, folder: Path) -> Iterator[Result]:
    """Run the commands of a page, then its Python blocks, in a folder of the page."""
    sim = ["cobotwire", "sim", "--quiet"]
    with subprocess.Popen(sim, stdout=subprocess.PIPE, text=True) as arm:
        assert arm.stdout is not None
        try:
            yield from _parts(path, plan, folder, arm.stdout.readline().strip())
        finally:
            arm.send_signal(signal.SIGINT)


def _parts(path: Path, plan: Plan, folder: Path, port: str) -> Iterator[Result]:
    prepare = ["bash", "-ec", PORT.sub(port, plan.prepare)]
    subprocess.run(prepare, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    for command, why in plan.unlike.items():
        yield Result(command, reason=why.reason)
    for done in run(path, folder, port, plan.unlike):
        yield Result(done.command, "" if done.matches else f"the page shows otherwise: {done}")
    page = path.read_text(encoding="utf-8")
    for command in commands(page):
        yield _checked(command, plan.commands.get(command), folder, port)
    yield from _programs(page, plan, folder, port)


def _checked(command: str, plan: Expected | NotRun | None, folder: Path, port: str) -> Result:
    if plan is None:
        return Result(command, "no plan says what it prints, or why it is not run")
    if isinstance(plan, NotRun):
        return Result(command, reason=plan.reason)
    if shutil.which(plan.shell) is None:
        return Result(command, reason=f"{plan.shell} is not installed here")
    return Result(command, _problem(PORT.sub(port, command), plan, folder))


def _problem(command: str, expected: Expected, folder: Path) -> str:
    # With exec, the program itself gets the signal.
    words = f"exec {command}" if expected.served else command
    process = subprocess.Popen(
        [expected.shell, "-c", f"{expected.before}\n{words}"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    printed = ""
    if expected.served:
        while not re.search(expected.output, printed) and (line := process.stdout.readline()):
            printed += line
        time.sleep(1)  # a recording gets some more messages
        process.send_signal(signal.SIGINT)
    try:
        printed += process.communicate(timeout=SECONDS)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        return f"it did not end within {SECONDS} s"
    codes = {expected.code} | ({0, 130, -signal.SIGINT} if expected.served else set())
    ended = expected.code == ANY or process.returncode in codes
    if ended and re.search(expected.output, printed):
        return ""
    return f"exit code {process.returncode}, and printed:\n{printed}"


def _programs(page: str, plan: Plan, folder: Path, port: str) -> Iterator[Result]:
    """Run the Python blocks of a page in one process, as a reader does who types them in."""
    planned, steps = [], []
    for block in programs(page):
        program = plan.programs.get(block.text.partition("\n")[0], Program())
        place = f"the Python block in line {block.line}"
        if isinstance(program, NotRun):
            yield Result(place, reason=program.reason)
        else:
            planned.append((place, block, program))
            steps.append((place, PORT.sub(port, program.setup), PORT.sub(port, block.text)))
    if not steps:
        return
    (folder / "steps.json").write_text(json.dumps(steps), encoding="utf-8")
    child = [sys.executable, "-c", CHILD, "steps.json"]
    done = subprocess.run(child, cwd=folder, capture_output=True, text=True, timeout=SECONDS)
    printed = done.stdout.split("\0")
    for (place, block, program), output in zip(planned, printed):
        pattern = output_pattern((block.shown or "").strip())
        same = block.shown is None or re.fullmatch(pattern, output.strip())
        fits = same and re.search(program.output, output)
        yield Result(place, "" if fits else f"it printed:\n{output}")
    for place, *_ in planned[len(printed) - 1 :]:
        yield Result(place, done.stderr.strip() or "not reached")
