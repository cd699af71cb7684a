"""The README, the landing page, the quick start and the list of subcommands."""

from __future__ import annotations

from newcomer.website.planned import ANY, INSTALLED, Expected, NotRun, Plan

PORT = "/dev/ttyACM0"
SIM = Expected(r"/dev/pts/\d+", served=True)
# What some commands read: a capture of one frame, a codec, and two reports.
PREPARE = r"""
mkdir captures
printf '\xFE\xFE\x0E\x20\x00\x8C\x00\x3D\xFF\xE6\xFF\x3F\x00\xAF\xFF\x51\xFA' > captures/a.bin
cp captures/a.bin b.bin
printf '#!/bin/sh\nexec python -m cobotwire.conformance.codec.adapter native\n' > my-codec
chmod +x my-codec
cobotwire conform device --simulated --json before.json > /dev/null
cp before.json after.json
"""

README = Plan(
    commands={
        "pip install cobotwire": INSTALLED,
        "make demo": NotRun("it is for a clone, with Rust; .ci/run runs it there"),
        "make test": NotRun("it is for a clone, with Rust; .ci/run runs it there"),
    },
)

CLI = Plan(
    prepare=PREPARE,
    commands={
        "cobotwire urdf mycobot280 -o arm.urdf": Expected("wrote arm.urdf"),
        f"cobotwire call {PORT} power_on": Expected(r"sent; acknowledged"),
        f"cobotwire call {PORT} send_angles 0,0,0,0,0,0 speed=30": Expected(r"sent"),
        "cobotwire decode FE FE 06 21 01 00 1D 14 FA": Expected(r"send_angle\(joint=1"),
        "cobotwire decode captures/ '*.bin' --summary": Expected(r"get_angles"),
        "cobotwire commands send_coord": Expected(r"send_coord  0x24"),
        "cobotwire sim": SIM,
        "cobotwire sim --scenario panic": SIM,
        "cobotwire ports": Expected(code=ANY),  # 1 if no port is likely
        f"cobotwire identify {PORT}": Expected(r"mycobot280"),
        f"cobotwire doctor {PORT}": Expected(r"mycobot280|firmware|version"),
        f"cobotwire survey {PORT} -o survey.zip": Expected(r"facts: \d+ confirmed, 0 contradicted"),
        "cobotwire studio": Expected(r"http://127\.0\.0\.1:\d+", served=True),
        f"cobotwire ros2 {PORT}": NotRun("the extra is not installed"),
        f"cobotwire mcp {PORT}": NotRun("a client of MCP starts it"),
        f"cobotwire tap {PORT}": Expected(r"/dev/pts/\d+", served=True),
        f"cobotwire monitor {PORT} --record arm.pcapng": Expected(r"get_angles", served=True),
        "cobotwire replay arm.pcapng": Expected(r"get_angles"),
        "cobotwire plot arm.pcapng -o arm.svg": Expected(),
        "cobotwire export arm.pcapng -o out/": Expected(r"get_angles"),
        "cobotwire decode arm.pcapng": Expected(r"get_angles"),
        f"cobotwire conform device {PORT}": Expected(r"\d+ pass"),
        "cobotwire conform client --listen pty": Expected(r"/dev/pts/\d+", served=True, code=2),
        "cobotwire conform codec -- ./my-codec": Expected(r"pass"),
        "cobotwire conform compare before.json after.json": Expected(),
        'eval "$(cobotwire completion bash)"': Expected(r"\A\Z"),
    },
)

ADD_COMMAND = Plan(
    commands={
        "pip install cobotwire cobotwire-codegen": INSTALLED,
        "cobotwire-gen init mine": Expected(r"mine\.yaml"),
        "cobotwire-gen build mine.yaml --out mypkg": Expected(r"mine \(\d+ commands\)"),
        "cobotwire --edition ./mypkg sim": SIM,
    },
)

INDEX = Plan(commands={"pip install cobotwire": INSTALLED})

START = Plan(
    commands={
        "pip install cobotwire": INSTALLED,
        "cobotwire ports": Expected(code=ANY),  # 1 if no port is likely
        f"cobotwire identify {PORT}": Expected(r"mycobot280"),
        f"cobotwire doctor {PORT}": Expected(r"mycobot280|firmware|version"),
        'eval "$(cobotwire completion bash)"': Expected(r"\A\Z"),
        'eval "$(cobotwire completion zsh)"': Expected(
            r"\A\Z", shell="zsh", before="autoload -U compinit && compinit -u -D"
        ),
        "cobotwire completion fish | source": Expected(r"\A\Z", shell="fish"),
    },
)
