"""The page on conformance."""

from __future__ import annotations

from newcomer.website.planned import Expected, Plan

DEVICE = "cobotwire --edition mycobot280 conform device"
PASSED = Expected(r"\d+ pass")

CONFORMANCE = Plan(
    # Programs that act as a firmware: on standard input, on a port, and with a port of their own.
    prepare=f"""
        cat > firmware <<'END'
#!/usr/bin/env python
import os, sys, tty
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm
arm = SimulatedArm(TABLE, powered=True)
source, sink = 0, 1
if len(sys.argv) > 1:
    source = sink = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
while data := os.read(source, 4096):
    os.write(sink, arm.receive(data))
END
        printf '#!/bin/sh\\nexec cobotwire sim --quiet\\n' > emulator
        chmod +x firmware emulator
        printf 'get_angles\\nsend_angles 10,0,0,0,0,0 30\\n' > calls.txt
        cobotwire conform device --simulated --json monday.json > /dev/null
        cp monday.json tuesday.json
        {DEVICE} /dev/ttyACM0 --json report.json > /dev/null
    """,
    commands={
        f"{DEVICE} /dev/ttyUSB0": PASSED,
        f"{DEVICE} socket://192.168.1.5:9000 --allow setting,malformed": PASSED,
        f"{DEVICE} --simulated --allow setting,malformed": PASSED,
        "cobotwire conform device --command ./firmware": PASSED,
        'cobotwire conform device --command "./firmware {port}"': PASSED,
        "cobotwire conform device --command ./emulator --attach port": PASSED,
        "cobotwire conform statement --edition mycobot280 > arm.yaml": Expected(r"\A\Z"),
        f"{DEVICE} /dev/ttyUSB0 --statement arm.yaml": PASSED,
        f"{DEVICE} /dev/ttyUSB0 --resume report.json --json whole.json": PASSED,
        f"{DEVICE} /dev/ttyUSB0 --again report.json": Expected(),
        "cobotwire --edition mycobot280 conform client --listen pty --idle 5": Expected(
            r"/dev/pts/\d+", served=True, code=2
        ),
        "cobotwire --edition mycobot280 conform client --listen socket://127.0.0.1:9000"
        # No client connects, so no call of the script is seen.
        " --expect calls.txt": Expected(r"socket://127\.0\.0\.1:9000", served=True, code=1),
        "cobotwire --edition mycobot280 conform codec -- python -m"
        " cobotwire.conformance.codec.adapter native": Expected(r"\d+ pass"),
        "cobotwire conform compare monday.json tuesday.json": Expected(),
        'ssh-keygen -t ed25519 -N "" -f laboratory': Expected(),
        "cobotwire conform device --simulated --json report.json --sign laboratory": PASSED,
        "cobotwire conform verify report.json --key laboratory.pub": Expected(
            "signed with the key"
        ),
    },
)
