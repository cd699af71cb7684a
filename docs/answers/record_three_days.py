"""Record three days of a simulated arm at work, in stepped time, as an example capture.

    python docs/answers/record_three_days.py three-days.pcapng

The arm works from 8 to 18 o'clock (UTC), and its joints grow warm. A program reads it every five
minutes. On the second day the controller panics at 14:20, and the program switches the power on
again. On the third day the line is slow.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from math import exp
from pathlib import Path

from cobotwire import codec
from cobotwire.capture import CaptureWriter, Interface, Packet
from cobotwire.editions.mycobot280 import TABLE, MyCobot280, messages
from cobotwire.editions.mycobot280.values import ServoTemperatures
from cobotwire.protocol.errors import CobotwireError
from cobotwire.session import Traffic
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.simulator.behaviour import Behaviours
from cobotwire.simulator.faults import Late, Panic, Scenario
from cobotwire.simulator.state import ArmState

BEGIN = datetime(2026, 11, 16, tzinfo=UTC)
DAY, HOUR, INTERVAL = 86_400.0, 3_600.0, 300.0
WORK_BEGIN, WORK_END = 8 * HOUR, 18 * HOUR
ROOM = 22.0
# The largest rise of each joint's temperature above the room's during work, in degrees Celsius. The
# shoulder carries the arm.
WARMING = (9.0, 24.0, 19.0, 11.0, 8.0, 5.0)
WARMING_SECONDS = 2 * HOUR
PANIC_SECONDS = 14 * HOUR + 20 * 60
POSES = ((0, 20, -40, 10, 0, 0), (60, -15, -70, 30, 0, 45), (-60, 30, -50, 0, 20, 0))


def temperature(joint: int, now: float) -> int:
    """Return the temperature of a joint at a time, in degrees Celsius."""
    day, second = divmod(now, DAY)
    worked = min(max(second - WORK_BEGIN, 0.0), WORK_END - WORK_BEGIN)
    rested = max(second - WORK_END, 0.0)
    share = (1 - exp(-worked / WARMING_SECONDS)) * exp(-rested / WARMING_SECONDS)
    return round(ROOM + WARMING[joint] * share * (1 + 0.1 * day))


behaviours = Behaviours()


@behaviours.behaviour(messages.GetServoTemps)
def get_servo_temps(
    arm: ArmState, now: float, request: messages.GetServoTemps
) -> messages.GetServoTempsReply:
    """Report the temperatures of joints that work."""
    joints = [temperature(joint, now) for joint in range(arm.joints)]
    return messages.GetServoTempsReply(ServoTemperatures(*joints))


QUICK = Late(seconds=0.006, jitter_seconds=0.004)
SLOW = Late(seconds=0.009, jitter_seconds=0.003)
VERY_SLOW = Late(seconds=0.02, jitter_seconds=0.06, probability=0.08)
PANIC = Panic(from_seconds=PANIC_SECONDS, until_seconds=PANIC_SECONDS + 0.01)
# What goes wrong on each day.
FAULTS = ((QUICK,), (QUICK, PANIC), (SLOW, VERY_SLOW))


@contextmanager
def capture(path: Path) -> Iterator[Callable[[Traffic], None]]:
    """Yield a function that records traffic; its times are the seconds since ``BEGIN``."""
    begin_ns = round(BEGIN.timestamp()) * 10**9
    with path.open("xb") as file:
        writer = CaptureWriter(file)
        index = writer.interface(Interface("/dev/ttyACM0", TABLE.edition, TABLE.baudrate))

        def record(traffic: Traffic) -> None:
            time_ns = begin_ns + round(traffic.time * 1e9)
            writer.packet(Packet(time_ns, traffic.direction, traffic.data, interface=index))

        yield record
        writer.finish()


def read_out(arm: MyCobot280) -> None:
    """Send the queries that docs/answers.md evaluates; the panic may lose a reply."""
    for query in (arm.get_angles, arm.get_servo_temps, arm.get_reboot_count):
        try:
            query()
        except CobotwireError as error:
            print(error, file=sys.stderr)
    if not arm.is_power_on():
        arm.power_on()


def work(arm: MyCobot280, clock: SteppedClock) -> None:
    """Let the arm work for a day, and read it."""
    begin = clock()
    for number in range(round(DAY / INTERVAL)):
        clock.sleep(begin + number * INTERVAL - clock())
        if WORK_BEGIN <= clock() % DAY < WORK_END:
            arm.send_angles(POSES[number % len(POSES)], 30)
        read_out(arm)
    clock.sleep(begin + DAY - clock())


def main(path: Path) -> None:
    """Write the capture."""
    clock = SteppedClock()
    simulated = SimulatedArm(TABLE, clock=clock, powered=True, behaviours=behaviours)
    with capture(path) as record:
        for day, faults in enumerate(FAULTS, 1):
            scenario = Scenario(name=f"day {day}", faults=faults, seed=day)
            peer = scenario.wrap(simulated, codec.load(TABLE), clock=clock)
            with MyCobot280(MemoryTransport(peer, clock)) as arm:
                arm.add_traffic_listener(record)
                work(arm, clock)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
