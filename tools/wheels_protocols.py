"""Build, simulate, decode and test protocols of other devices as a user does, in one environment.

    python wheels_protocols.py FOLDER    # the folder of feetech.yaml and ublox.yaml

`make wheels-check` runs it in fresh environments, without Rust. It copies the specs, and runs the
commands that the documentation names: the generator, a simulated device, the decoder, and the
conformance tests of devices, clients and codecs.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from ruamel.yaml import YAML

SECONDS = 300


class Protocol(NamedTuple):
    """A protocol, and calls of it: a line for the command line, the same in Python, and the output.

    ``to`` is the address of the device; empty if frames have none. ``names_replies`` says whether
    replies contain the id of their command.
    """

    name: str
    to: str
    names_replies: bool
    calls: tuple[tuple[str, str, str], ...]


PROTOCOLS = (
    Protocol(
        "feetech",
        "7",
        False,
        (
            ("write_goal 2048 0 1000", "write_goal(2048, 0, 1000)", "overload=False"),
            ("read_all", "read_all()", "measured=Measured(position="),
        ),
    ),
    Protocol(
        "ublox",
        "",
        True,
        (
            ("set_rate 200 1 GPS", "set_rate(200, 1, p.TimeReference.GPS)", ""),
            ("get_rate", "get_rate()", "period=200"),
            ("get_version", "get_version()", "software="),
            ("get_position", "get_position()", "latitude="),
        ),
    ),
)
CLIENT = """\
import sys
import {name} as p
with p.CLIENT(sys.argv[1], timeout=10{address}) as device:
    device.{calls}
"""


class Wrong(Exception):
    """A command failed or printed something else; the text names the command and the difference."""


def main() -> int:
    """Try each protocol; return 1 if one fails."""
    specs = Path(sys.argv[1])
    os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    os.environ.pop("PYTHONPATH", None)
    if rust := shutil.which("cargo") or shutil.which("rustc"):
        print(f"FAIL  this environment has Rust: {rust}")
        return 1
    failed = 0
    for protocol in PROTOCOLS:
        with tempfile.TemporaryDirectory(prefix="cobotwire-protocol-") as name:
            folder = Path(name)
            shutil.copy(specs / f"{protocol.name}.yaml", folder)
            try:
                _try(protocol, folder)
            except (Wrong, subprocess.TimeoutExpired) as error:
                failed += 1
                print(f"FAIL  {protocol.name}: {error}", flush=True)
    return 1 if failed else 0


def _try(protocol: Protocol, folder: Path) -> None:
    """Use a protocol in a folder that has its spec.

    Raises:
        Wrong: a command failed.
    """
    name, spec = protocol.name, f"{protocol.name}.yaml"
    edition = ("cobotwire", "--edition", f"./{name}")
    to = ("--address", protocol.to) if protocol.to else ()

    def run(*words: str, prints: str) -> None:
        _run(words, folder, [prints])

    run("cobotwire-gen", "check", spec, prints="no problems")
    run("cobotwire-gen", "build", spec, "--out", name, prints=f"{name} (")
    with _simulated(name, folder) as port:
        for number, (line, _, printed) in enumerate(protocol.calls):
            kept = ("--record", f"{number}.pcapng", "--timeout", "10")
            run(*edition, "call", port, *line.split(), *to, *kept, prints=printed)
            command = line.partition(" ")[0]
            run(*edition, "decode", f"{number}.pcapng", prints=f"{command}(")
        permissions = ("--allow", "setting,malformed")
        run(*edition, "conform", "device", port, *to, *permissions, prints=" pass")
    frames = list(_frames(protocol, folder / spec))
    decode = (*edition, "decode", *(frame for frame, _ in frames))
    _run(decode, folder, [printed for _, printed in frames])
    _write_client(protocol, folder)
    client = ("--command", f"{sys.executable} client.py {{port}}", "--expect", "calls.txt")
    run(*edition, "conform", "client", *client, prints=" pass")
    for codec in ("native", "reference"):
        adapter = (sys.executable, "-m", "cobotwire.conformance.codec.adapter", codec)
        run(*edition, "conform", "codec", "--", *adapter, prints=" pass")


def _run(words: tuple[str, ...], folder: Path, prints: list[str]) -> None:
    ended = subprocess.run(  # noqa: S603
        words, cwd=folder, capture_output=True, text=True, timeout=SECONDS
    )
    shown = " ".join(words)
    missing = [each for each in prints if each not in ended.stdout]
    if ended.returncode or missing:
        output = f"{ended.stdout}{ended.stderr}".strip()
        lacks = f", and did not print {missing}" if missing else ""
        raise Wrong(f"`{shown}` ended with {ended.returncode}{lacks}:\n{output}")
    print(f"ok    {shown}", flush=True)


@contextmanager
def _simulated(name: str, folder: Path) -> Iterator[str]:
    """Serve a simulated device; yield its port."""
    words = ("cobotwire", "--edition", f"./{name}", "sim", "--quiet")
    process = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True)  # noqa: S603
    assert process.stdout is not None
    try:
        port = process.stdout.readline().strip()
        if not port:
            raise Wrong(f"`{' '.join(words)}` printed no port")
        yield port
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(SECONDS)


def _frames(protocol: Protocol, spec: Path) -> Iterator[tuple[str, str]]:
    """Yield the frames of the makers' documents that the spec has, and what decoding prints."""
    for vector in YAML(typ="safe").load(spec)["vectors"]:
        named = f"{vector['command']}("
        if vector["direction"] == "request":
            yield vector["frame"], f"request: {named}"
        else:
            yield vector["frame"], f"-> {named}" if protocol.names_replies else "reply: -> "


def _write_client(protocol: Protocol, folder: Path) -> None:
    """Write a program that makes the calls, and a file of the same calls for the client tester."""
    address = f", address={protocol.to}" if protocol.to else ""
    calls = "\n    device.".join(call for _, call, _ in protocol.calls)
    text = CLIENT.format(name=protocol.name, address=address, calls=calls)
    (folder / "client.py").write_text(text, "utf-8")
    to = f" --address {protocol.to}" if protocol.to else ""
    lines = "".join(f"{line}{to}\n" for line, _, _ in protocol.calls)
    (folder / "calls.txt").write_text(lines, "utf-8")


if __name__ == "__main__":
    sys.exit(main())
