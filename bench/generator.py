"""Measure how long the generator takes: each row times a whole process, including its start."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from responder import within

ROOT = Path(__file__).parent.parent
TURNS = 5


def main() -> None:
    """Measure, and print the seconds with their limits."""
    with tempfile.TemporaryDirectory() as folder:
        big = Path(folder) / "big.yaml"
        big.write_text(_big())
        rows = [
            ("generate all editions (--check)", ["--root", str(ROOT), "--check"], 3.0),
            ("check a spec of 400 commands", ["check", str(big)], 5.0),
        ]
        for what, words, limit in rows:
            median = sorted(_seconds(words) for _ in range(TURNS))[TURNS // 2]
            print(f"{what:34} {median:6.2f} s   {within(median <= limit)} {limit:.0f} s")


def _seconds(words: list[str]) -> float:
    started = time.perf_counter()
    command = [sys.executable, "-m", "cobotwire_codegen", *words]
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - started


def _big() -> str:
    """Return a protocol of 400 commands; those that share an id differ in length."""
    head = (ROOT / "tests/codegen/lamp.yaml").read_text().partition("commands:\n")[0]
    commands, vectors = [], []
    for index in range(400):
        id, count = index % 250, index // 250 + 1
        fields = "".join(f"      - {{name: f{n}, is: channel}}\n" for n in range(count))
        # After the 250th command the ids repeat, with more data.
        shared = f"    shares_id: call{id}\n" if count > 1 else ""
        commands.append(
            f"  call{index}:\n    id: {id}\n{shared}    title: Call\n    doc: Calls.\n"
            f"    safety: setting\n    request:\n{fields}"
        )
        values = ", ".join(f"f{n}: 1" for n in range(count))
        frame = f"FE FE {2 + count:02X} {id:02X} {'01 ' * count}FA"
        vectors.append(
            f"  - {{name: v{index}, command: call{index}, direction: request, "
            f"frame: {frame}, values: {{{values}}}}}\n"
        )
    return f"{head}commands:\n{''.join(commands)}\nvectors:\n{''.join(vectors)}"


if __name__ == "__main__":
    main()
