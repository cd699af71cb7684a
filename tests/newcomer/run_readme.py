"""Run every command of the README with the programs of this environment, and compare the output.

    python run_readme.py README.md

`make wheels-check` runs it in fresh environments. The `console` blocks show their output; EXPECTED
has that of the commands in indented blocks, which act on a simulated arm. A command that EXPECTED
lacks is a failure, so that no new one goes unchecked.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from docs.pages import PORT, SECONDS, run

ANY = -1


class Expected(NamedTuple):
    """What a command prints, as a regular expression that the output contains, and how it ends."""

    output: str
    code: int = 0
    # Whether the command runs until Ctrl-C, which follows the expected output.
    served: bool = False


# By the words before the first comment.
EXPECTED = {
    "make demo": None,  # these two are for a clone
    "make test": None,
    "pip install cobotwire cobotwire-codegen": None,  # the wheels are installed already
    f"cobotwire call {PORT} send_angles 0,0,0,0,0,0 speed=30": Expected(r"\A\Z|sent"),
    "cobotwire decode FE FE 06 21 01 00 1D 14 FA": Expected(r"send_angle\(joint=1"),
    "cobotwire decode captures/ '*.bin' --summary": Expected(r"get_angles"),
    "cobotwire commands send_coord": Expected(r"send_coord  0x24"),
    "cobotwire sim": Expected(r"/dev/pts/\d+", served=True),
    "cobotwire sim --scenario panic": Expected(r"/dev/pts/\d+", served=True),
    "cobotwire ports": Expected(r"", code=ANY),  # 1 if no port is likely
    f"cobotwire identify {PORT}": Expected(r"mycobot280"),
    f"cobotwire doctor {PORT}": Expected(r"mycobot280|firmware|version"),
    "cobotwire studio": Expected(r"http://127\.0\.0\.1:\d+", served=True),
    f"cobotwire monitor {PORT} --record arm.pcapng": Expected(r"get_angles", served=True),
    "cobotwire replay arm.pcapng": Expected(r"get_angles"),
    "cobotwire plot arm.pcapng -o arm.svg": Expected(r""),
    "cobotwire export arm.pcapng -o out/": Expected(r"get_angles"),
    "cobotwire decode arm.pcapng": Expected(r"get_angles"),
    f"cobotwire conform device {PORT}": Expected(r"\d+ pass"),
    "cobotwire conform client --listen pty": Expected(r"/dev/pts/\d+", served=True, code=2),
    "cobotwire conform codec -- ./my-codec": Expected(r"pass"),
    "cobotwire conform compare before.json after.json": Expected(r""),
    'eval "$(cobotwire completion bash)"': Expected(r"\A\Z"),
    "cobotwire-gen init mine": Expected(r"mine\.yaml"),
    "cobotwire-gen build mine.yaml --out mypkg": Expected(r"mine \(\d+ commands\)"),
    "cobotwire --edition ./mypkg sim": Expected(r"/dev/pts/\d+", served=True),
}
# What some commands read: a capture of one frame, a codec, and two reports.
FRAME = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
PREPARE = """
printf '#!/bin/sh\\nexec python -m cobotwire.conformance.codec.adapter native\\n' > my-codec
chmod +x my-codec
cobotwire conform device --simulated --json before.json > /dev/null
cp before.json after.json
"""


class Problem(Exception):
    """A command did not do what the README says."""


def indented(text: str) -> Iterator[str]:
    """Yield the commands of the indented blocks, without their comments."""
    for line in re.findall(r"^    (\S.*)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), re.M):
        yield re.sub(r"\s+# .*", "", line).strip()


def _started(command: str, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        ["bash", "-c", command],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
    )


def check(command: str, expected: Expected, folder: Path, port: str) -> None:
    """Run a command.

    Raises:
        Problem: it printed something else, ended otherwise, or did not end.
    """
    command = command.replace(PORT, port)
    # With exec, the program itself gets the signal.
    process = _started(f"exec {command}" if expected.served else command, folder)
    assert process.stdout is not None
    printed = ""
    if expected.served:
        while not re.search(expected.output, printed) and (line := process.stdout.readline()):
            printed += line
        time.sleep(1)  # a recording gets some more messages
        process.send_signal(signal.SIGINT)
    printed += process.communicate(timeout=SECONDS * 5)[0]
    codes = {expected.code} | ({0, 130, -signal.SIGINT} if expected.served else set())
    ended = expected.code == ANY or process.returncode in codes
    if not ended or not re.search(expected.output, printed):
        raise Problem(f"exit code {process.returncode}, and printed:\n{printed}")


def main() -> int:
    """Run everything; return 1 if something is not as the README says."""
    os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    os.environ.pop("PYTHONPATH", None)
    readme = Path(sys.argv[1])
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        arm = subprocess.Popen(
            ["cobotwire", "sim", "--powered", "--quiet"], stdout=subprocess.PIPE, text=True
        )
        assert arm.stdout is not None
        port = arm.stdout.readline().strip()
        for done in run(readme, folder, port):
            failed += not done.matches
            print("ok  " if done.matches else f"FAIL {done}", done.command, flush=True)
        (folder / "captures").mkdir()
        for file in ("captures/a.bin", "b.bin"):
            (folder / file).write_bytes(FRAME)
        subprocess.run(["bash", "-ec", PREPARE], cwd=folder, check=True)
        for command in indented(readme.read_text(encoding="utf-8")):
            try:
                expected = EXPECTED[command]
                if expected is not None:
                    check(command, expected, folder, port)
                print("ok   " if expected else "skip ", command, flush=True)
            except (KeyError, Problem, subprocess.TimeoutExpired) as error:
                failed += 1
                print("FAIL ", command, error, flush=True)
        arm.send_signal(signal.SIGINT)
        arm.wait()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
