"""Use a device of your own: its client, its simulator and its errors come from lamp.yaml.

    cobotwire-gen build lamp.yaml --out lamp
    python use_lamp.py [PORT]

Without a port it uses a simulated lamp, which remembers its brightness because lamp.yaml says which
command reads what another one sets (`effect`).
"""

import sys

from lamp import TABLE, Lamp

from cobotwire import UsageError
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock


def main(port: str | None = None) -> None:
    """Dim the lamp, read it, and try a value that the spec does not allow."""
    clock = SteppedClock()
    with Lamp(port or MemoryTransport(SimulatedArm(TABLE, clock=clock), clock)) as lamp:
        lamp.set_brightness(40)
        print(f"the lamp is at {lamp.get_brightness()} percent")
        try:
            lamp.set_brightness(101)
        except UsageError as error:
            print(error)  # nothing was sent


if __name__ == "__main__":
    main(*sys.argv[1:])
