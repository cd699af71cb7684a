"""Measure an export of one large raw file on a Dask cluster of one worker and of two.

Each run starts its own processes. Runs with one and two workers alternate, so that other load on
the machine favours neither. The bench prints the time from the first task to the last file, the
processor time of each worker (other load changes it less), and the peak memory.

    python bench/archive_workers.py [--megabytes 2000] [--rounds 3]
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from distributed import Client, LocalCluster

from cobotwire.capture import archive
from cobotwire.capture.archive import DaskEngine
from cobotwire.capture.export import ExportPlan, Inputs, Report
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.inspect.exporting import InstalledEditions
from streams import stream_a


class Run(NamedTuple):
    """One export.

    Attributes:
        seconds: the time that it took.
        busy: the processor time of each worker, in seconds.
        peaks: the peak memory of each worker, in bytes.
        report: what was exported.
    """

    seconds: float
    busy: list[float]
    peaks: list[int]
    report: Report


def peak() -> int:
    """Return the peak of this process's memory in bytes."""
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0]) * 1024


def prepare() -> None:
    """Import and load what an export needs."""
    import cobotwire.capture.archive.exporting  # noqa: F401

    InstalledEditions("mycobot280").codec("")


def measure(inputs: Inputs, workers: int, folder: Path, piece_bytes: int) -> Run:
    """Export with new worker processes; remove what they wrote."""
    plan = ExportPlan(str(folder / "out"), InstalledEditions("mycobot280"), direction="reply")
    with (
        LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0"
        ) as cluster,
        Client(cluster) as client,
    ):
        # Imports are not timed.
        client.run(prepare)
        engine = DaskEngine(cluster.scheduler_address)
        before = client.run(time.process_time)
        started = time.perf_counter()
        report = archive.export(plan, inputs, engine, piece_bytes=piece_bytes)
        seconds = time.perf_counter() - started
        busy = [after - before[worker] for worker, after in client.run(time.process_time).items()]
        peaks = list(client.run(peak).values())
    shutil.rmtree(folder / "out")
    return Run(seconds, busy, peaks, report)


def _seconds(busy: list[float]) -> str:
    return " + ".join(f"{seconds:.1f} s" for seconds in busy)


def write_capture(path: Path, megabytes: int) -> None:
    """Write frames of several commands with some noise between them."""
    part = stream_a(TABLE, 1_000_000).data
    noise = bytes(range(7)) + part[:11]
    with path.open("wb") as file:
        while file.tell() < megabytes * 1_000_000:
            file.write(part)
            file.write(noise)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--piece-megabytes", type=int, default=archive.PIECE_BYTES >> 20)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="cobotwire-bench-") as name:
        folder = Path(name)
        write_capture(folder / "arm.bin", options.megabytes)
        inputs = Inputs.find([str(folder / "arm.bin")])
        ratios = []
        for turn in range(options.rounds):
            order = (1, 2) if turn % 2 else (2, 1)
            runs = {
                workers: measure(inputs, workers, folder, options.piece_megabytes << 20)
                for workers in order
            }
            one, two = runs[1], runs[2]
            same = one.report.rows == two.report.rows and one.report.noise == two.report.noise
            ratios.append(one.seconds / two.seconds)
            most = max(one.peaks + two.peaks) / 1e6
            print(
                f"1 worker {one.seconds:6.1f} s, 2 workers {two.seconds:6.1f} s: "
                f"{ratios[-1]:.2f} x; busy {_seconds(one.busy)} and {_seconds(two.busy)}; "
                f"at most {most:.0f} MB a worker; {one.report.frames:,} frames, "
                f"counts {'agree' if same else 'DIFFER'}",
                flush=True,
            )
        low, high = min(ratios), max(ratios)
        print(f"2 workers: {statistics.median(ratios):.2f} x ({low:.2f} to {high:.2f}); target 1.7")


if __name__ == "__main__":
    main()
