"""Run every fuzz target for a while and print what it covered: ``run.py SECONDS [TARGET...]``.

libFuzzer does the fuzzing; this script builds, writes seeds, sets limits and reports.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TOOLS = ROOT / ".cargo-tools" / "bin"
# The largest input of each target: a stream, or a table with a stream. It is long enough for
# several frames in any arrangement, and short enough for thousands of runs a second.
LARGEST = {
    "framer": 1024,
    "chunks": 1024,
    "decode": 1024,
    "columns": 1024,
    "tables": 512,
    "linear": 256,
    "captures": 512,
    "exchange": 512,
}
# An input that takes longer is a hang: every correct run is much shorter.
SECONDS_FOR_ONE_INPUT = 20
SECONDS_TO_MINIMISE = 20
MEGABYTES = 1024


class Outcome(NamedTuple):
    """One target's run."""

    target: str
    seconds: float
    runs: int
    edges: int
    of: int
    features: int
    corpus: int
    crashes: list[Path]
    ended_well: bool


def main(seconds: int, targets: list[str]) -> int:
    """Build, run and report; return 1 if a target failed."""
    binaries = _build()
    _seeds()
    outcomes = [_run(target, binaries / target, seconds) for target in targets]
    print(f"\n{'target':8} {'seconds':>8} {'runs':>10} {'edges':>13} {'features':>9} {'corpus':>7}")
    for o in outcomes:
        covered = f"{o.edges} of {o.of}"
        verdict = "ok" if o.ended_well else "FAILED"
        print(
            f"{o.target:8} {o.seconds:8.0f} {o.runs:10,} {covered:>13} {o.features:9,} "
            f"{o.corpus:7,}   {verdict}"
        )
    print("edges: of the whole program, including the oracle and the reader of tables")
    for outcome in outcomes:
        for crash in outcome.crashes:
            _explain(outcome.target, binaries / outcome.target, crash)
    return 0 if all(outcome.ended_well for outcome in outcomes) else 1


def _build() -> Path:
    """Build the instrumented targets; without a sanitizer, since the core has no unsafe code."""
    path = f"{TOOLS}{os.pathsep}{os.environ['PATH']}"
    command = ["cargo", "fuzz", "build", "--fuzz-dir", str(HERE), "--sanitizer", "none"]
    # cargo-fuzz searches for the fuzzed package from the folder in which it starts.
    _call(command, cwd=ROOT / "rust" / "core", env={**os.environ, "PATH": path})
    version = subprocess.run(
        ["rustc", "-vV"],  # noqa: S607  (the compiler on PATH is intended)
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    host = re.search(r"^host: (\S+)", version, re.MULTILINE)
    assert host is not None, "rustc prints its host"
    return HERE / "target" / host[1] / "release"


def _seeds() -> None:
    _call([*_example("seeds"), str(HERE / "corpus")])


def _example(name: str) -> list[str]:
    manifest = str(HERE / "Cargo.toml")
    return ["cargo", "run", "--quiet", "--manifest-path", manifest, "--example", name, "--"]


def _call(
    command: list[str], *, cwd: Path | None = None, env: dict[str, str] | None = None
) -> None:
    subprocess.run(command, check=True, cwd=cwd, env=env)  # noqa: S603  (cargo)


def _run(target: str, binary: Path, seconds: int) -> Outcome:
    corpus, artifacts = HERE / "corpus" / target, HERE / "artifacts" / target
    corpus.mkdir(parents=True, exist_ok=True)
    artifacts.mkdir(parents=True, exist_ok=True)
    before = set(artifacts.iterdir())
    print(f"{target}: {seconds} s", flush=True)
    started = time.monotonic()
    done = subprocess.run(  # noqa: S603  (built above)
        [
            str(binary),
            str(corpus),
            f"-max_total_time={seconds}",
            f"-max_len={LARGEST[target]}",
            f"-timeout={SECONDS_FOR_ONE_INPUT}",
            f"-rss_limit_mb={MEGABYTES}",
            f"-artifact_prefix={artifacts}/",
            "-print_final_stats=1",
        ],
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
    )
    took = time.monotonic() - started
    (artifacts.parent / f"{target}.log").write_text(done.stderr)
    crashes = sorted(set(artifacts.iterdir()) - before)
    return _outcome(target, took, done.stderr, crashes, done.returncode == 0)


def _outcome(target: str, took: float, log: str, crashes: list[Path], well: bool) -> Outcome:
    def last(pattern: str) -> int:
        found = re.findall(pattern, log)
        return int(found[-1]) if found else 0

    return Outcome(
        target,
        took,
        last(r"number_of_executed_units:\s*(\d+)"),
        last(r" cov: (\d+)"),
        last(r"\((\d+) inline 8-bit counters\)"),
        last(r" ft: (\d+)"),
        last(r" corp: (\d+)/"),
        crashes,
        well,
    )


def _explain(target: str, binary: Path, crash: Path) -> None:
    """Print how to repeat a crash, with a smaller input if one is found, and its test line."""
    small = crash.with_name(f"smaller-{crash.name}")
    if crash.name.startswith("crash-"):
        subprocess.run(  # noqa: S603
            [
                str(binary),
                "-minimize_crash=1",
                f"-max_total_time={SECONDS_TO_MINIMISE}",
                f"-exact_artifact_path={small}",
                str(crash),
            ],
            capture_output=True,
        )
    if small.exists():
        crash = small
    done = subprocess.run([str(binary), str(crash)], capture_output=True, text=True)  # noqa: S603
    words = re.search(r"panicked at .*\n(?:.*\n){0,3}", done.stderr)
    print(f"\n{target} failed: {words[0].strip() if words else 'see its log'}")
    print(f"  repeat: {shlex.join([str(binary), str(crash)])}")
    print("  for tests/found, with the oracle's result as the last part:", flush=True)
    _call([*_example("describe"), target, str(crash)])


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), sys.argv[2:] or list(LARGEST)))
