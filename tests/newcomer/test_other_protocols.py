"""Use protocols of other devices from the wheels, without Rust, with each of the two codecs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import vectors
from newcomer.installing import run

CALLS = {
    "feetech": """
    print(device.write_goal(2048, 0, 1000) == device.ping())
    device.every.sync_write_goals([p.ServoTarget(1, 2048, 0, 1000), p.ServoTarget(2, 1024, 0, 500)])
    print(device.read_all()[1].voltage)
""",
    "ublox": """
    device.set_rate(200, 1, p.TimeReference.GPS)
    print(device.get_rate().period)
    print(device.get_version().extensions == ())
""",
}
SCRIPT = """
import sys
import {name} as p
from cobotwire.simulator import PtyServer, SimulatedArm
server = PtyServer(SimulatedArm(p.TABLE))
with server, p.CLIENT(server.url, timeout=10, record="a.pcapng") as device:
    print(device.codec)
{calls}
print("cobotwire._native" in sys.modules)
"""
PRINTED = {"feetech": ["True", "0.0"], "ublox": ["200", "True"]}
# The frames were recorded in both directions; these requests were sent.
DECODED = {
    "feetech": "sync_write_goals(register=42, count=6, targets=(1; 2048 ticks;",
    "ublox": "set_rate(period=200 milliseconds",
}


# `make wheels-check` uses more protocols, with the native codec.
@pytest.mark.parametrize(("name", "codec"), [("feetech", "native"), ("ublox", "reference")])
def test_protocol_is_built_simulated_recorded_decoded_and_tested_without_rust(
    tmp_path: Path, environment: dict[str, str], fresh: Path, name: str, codec: str
) -> None:
    spec = vectors.ROOT / "tests" / "protocols" / f"{name}.yaml"
    (tmp_path / spec.name).write_bytes(spec.read_bytes())
    (tmp_path / "drive.py").write_text(SCRIPT.format(name=name, calls=CALLS[name]))
    within = {**environment, "PATH": str(fresh), "COBOTWIRE_CODEC": codec}

    def output(*words: str) -> str:
        return run(*words, cwd=tmp_path, env=within).stdout

    assert name in output("cobotwire-gen", "build", spec.name, "--out", name)
    assert output("python", "drive.py").splitlines() == [
        *(codec, *PRINTED[name]),
        str(codec == "native"),
    ]
    sent = DECODED[name].partition("(")[0]
    assert sent in output("cobotwire", "--edition", f"./{name}", "commands")
    assert DECODED[name] in output("cobotwire", "--edition", name, "decode", "a.pcapng")
    tested = output(
        "cobotwire", "--edition", name, "conform", "device", "--simulated", "--json", "-"
    )
    verdicts = [result["verdict"] for result in json.loads(tested)["results"]]
    assert "pass" in verdicts
    assert "fail" not in verdicts
    with pytest.raises(FileNotFoundError):
        run("cargo", "--version", env=within)
