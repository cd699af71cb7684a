"""Compare the import time of cobotwire with pymycobot's, and measure its installed size.

Each import runs in its own process, and all candidates take turns. Only the import is timed, not
the start of Python. The median counts. ``import cobotwire`` loads a name only on its first use, so
a second row imports the client.

A program imports a client and opens it, so both together have one limit. With the layer that has
the maker's names, both together may take 1.3 times as long.

The installed size has two limits: one for the average edition, since editions are added, and one
for the rest of the package.
"""

from __future__ import annotations

import compileall
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from responder import within

ROOT = Path(__file__).parents[1]
TURNS = 15
TIMES_FASTER = 5.0
LAYER_LIMIT = 1.3
# The most MiB of an edition on average, of all else together, and of the wheel.
EDITION_SIZE, OTHER_SIZE, WHEEL_SIZE = 0.5, 10.0, 3.0
MIB = 1 << 20
START = "import sys; sys.argv[1:] = {!r}; from cobotwire.cli import main; main()"
MEMORY = """
class Memory:
    url = "memory"
    def write(self, data): pass
    def read(self, timeout): return b""
    def close(self): pass
"""
OPEN = f"from cobotwire import MyCobot280{MEMORY}MyCobot280(Memory())"
# The layer's class takes the name of a port; this subclass opens the memory instead.
LAYER = "from cobotwire.pymycobot import MyCobot280"
OPEN_LAYER = f"""{LAYER}{MEMORY}
class Arm(MyCobot280):
    def __init__(self): self._open(lambda: self.NATIVE(Memory()), False, None)
Arm()"""
OPEN_ASYNC = f"from cobotwire import AsyncMyCobot280{MEMORY}AsyncMyCobot280(Memory())"
OUR_CLIENT, THE_LAYER = "import and open a client", "import and open it through the layer"
# Programs, and how many times as long as a bare interpreter each may take.
STARTS: dict[str, tuple[str, float | None]] = {
    "cobotwire --version": (START.format(["--version"]), 8.0),
    "cobotwire --help": (START.format(["--help"]), 8.0),
    "cobotwire decode HEX": (START.format(["decode", "FE FE 02 12 FA"]), 8.0),
    "cobotwire decode HEX, noise": (START.format(["decode", "FF FE 02 12 FA"]), 8.0),
    OUR_CLIENT: (OPEN, 7.0),
    # Rows without a limit.
    THE_LAYER: (OPEN_LAYER, None),
    "import and open an asyncio client": (OPEN_ASYNC, None),
    # Modules of the standard library and click, which take part of the time of our imports.
    "import typing": ("import typing", None),
    "import typing, dataclasses": ("import typing, dataclasses", None),
    "import typing, logging": ("import typing, logging", None),
    "import click": ("import click", None),
}
TIMED = "import time; t = time.perf_counter(); {}; print(time.perf_counter() - t)"
IMPORTS = {
    "cobotwire": "import cobotwire",
    "pymycobot": "import pymycobot",
    "cobotwire's client": "from cobotwire import MyCobot",
    "pymycobot's client": "from pymycobot import MyCobot280",
}


def main() -> None:
    """Measure, and print the ratios with their limits."""
    with tempfile.TemporaryDirectory() as cache:
        # Compiled modules are kept, as for users, even if the environment turns that off.
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        os.environ["PYTHONPYCACHEPREFIX"] = cache
        _times()
        _starts()
    _size()


def _times() -> None:
    taken: dict[str, list[float]] = {name: [] for name in IMPORTS}
    for turn in range(TURNS + 1):
        for name, statement in IMPORTS.items():
            seconds = _timed(statement)
            # The first turn only fills the caches.
            if turn:
                taken[name].append(seconds)
    middle = {name: statistics.median(times) for name, times in taken.items()}
    for ours, theirs, limit in (
        ("cobotwire", "pymycobot", TIMES_FASTER),
        ("cobotwire's client", "pymycobot's client", None),
    ):
        faster = middle[theirs] / middle[ours]
        verdict = "" if limit is None else f"   {within(faster >= limit)} {limit:.0f} x"
        print(
            f"{IMPORTS[ours]:30} {middle[ours] * 1e3:6.1f} ms   {faster:5.1f} x faster than "
            f"{IMPORTS[theirs]} ({middle[theirs] * 1e3:.1f} ms){verdict}"
        )


def _starts() -> None:
    """Print how much processor time a process takes, compared with a bare interpreter."""
    bare: list[float] = []
    taken: dict[str, list[float]] = {name: [] for name in STARTS}
    for turn in range(TURNS + 1):
        seconds = {name: _cpu(code) for name, (code, _) in STARTS.items()}
        alone = _cpu("pass")
        if turn:
            bare.append(alone)
            for name, spent in seconds.items():
                taken[name].append(spent)
    for name, (_, limit) in STARTS.items():
        times = statistics.median(taken[name]) / statistics.median(bare)
        verdict = "" if limit is None else f"   {within(times <= limit)} {limit:.0f} x"
        print(f"{name:44} {times:5.1f} x a bare interpreter{verdict}")
    # The machine's speed may change between turns, so the ratio is of two times of one turn.
    shares = [layer / ours for layer, ours in zip(taken[THE_LAYER], taken[OUR_CLIENT])]
    share = statistics.median(shares)
    verdict = within(share <= LAYER_LIMIT)
    print(f"{THE_LAYER:44} {share:5.2f} x opening our client   {verdict} {LAYER_LIMIT} x")


def _cpu(code: str) -> float:
    """Run code in a process of its own; return its processor time in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, check=False)
    # The exit code is 1 if bytes are noise.
    assert result.returncode in (0, 1), code
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _timed(statement: str) -> float:
    command = [sys.executable, "-c", TIMED.format(statement)]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    return float(result.stdout)


def _size() -> None:
    """Build the wheel, unpack and compile it as pip does, and print its size."""
    with tempfile.TemporaryDirectory() as folder:
        maturin = [sys.executable, "-m", "maturin", "build", "--release", "--quiet"]
        subprocess.run([*maturin, "--out", folder], cwd=ROOT, check=True, capture_output=True)
        wheel = next(Path(folder).glob("*.whl"))
        unpacked = Path(folder) / "unpacked"
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(unpacked)
        compileall.compile_dir(unpacked, quiet=1)
        editions = unpacked / "cobotwire" / "editions"
        count = sum(1 for each in editions.iterdir() if (each / "edition.json").exists())
        of_editions, packed = _mib(editions), wheel.stat().st_size / MIB
        other = _mib(unpacked) - of_editions
    for what, size, limit in (
        (f"an edition, on average of {count}", of_editions / count, EDITION_SIZE),
        ("all else", other, OTHER_SIZE),
        ("the wheel, packed", packed, WHEEL_SIZE),
    ):
        name = f"size without extras: {what}"
        print(f"{name:54} {size:5.2f} MiB   {within(size <= limit)} {limit:g} MiB")


def _mib(folder: Path) -> float:
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) / MIB


if __name__ == "__main__":
    main()
