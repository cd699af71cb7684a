"""Read the latency timer of a USB adapter."""

from __future__ import annotations

from pathlib import Path

from cobotwire.inspect.latency_timer import latency_timer


def test_latency_timer_is_read_if_the_port_has_one(tmp_path: Path) -> None:
    folder = tmp_path / "class" / "tty" / "ttyUSB7" / "device"
    folder.mkdir(parents=True)
    (folder / "latency_timer").write_text("16\n")
    assert latency_timer("/dev/ttyUSB7", tmp_path) == (16, folder / "latency_timer")
    assert latency_timer("/dev/ttyACM0", tmp_path) is None
    assert latency_timer("socket://ttyUSB7:1", tmp_path) is None
