"""Jog the joints with the keyboard of a terminal: keyboard_jog.py PORT.

    1 to 6   choose a joint
    + and -  turn it by a step of 5 degrees
    h        send all joints home
    space    stop the arm
    q        quit

It runs on Linux and macOS.
"""

import os
import select
import sys
import termios
import tty
from collections.abc import Iterator

from cobotwire import CobotwireError, MyCobot280

STEP = 5  # degrees
SPEED = 30  # percent
SHOW_SECONDS = 0.1


def main(port: str) -> None:
    """Read keys until q; show where the arm is."""
    joint = 1
    with MyCobot280(port) as arm:
        arm.power_on()
        for key in keys():
            try:
                if key == "q":
                    break
                if key in "123456":
                    joint = int(key or joint)
                press(arm, joint, key)
                show(joint, arm.get_angles())
            except CobotwireError as error:
                print(f"\r\n{error}\r")
    print("\r\nbye")


def press(arm: MyCobot280, joint: int, key: str) -> None:
    """Do what a key means. A step beyond a limit raises an error, and nothing is sent."""
    match key:
        case "+" | "-":
            step = STEP if key == "+" else -STEP
            arm.jog_increment(joint, step, SPEED)
        case "h":
            arm.send_angles([0, 0, 0, 0, 0, 0], SPEED)
        case " ":
            arm.stop()


def show(joint: int, angles: tuple[float, ...]) -> None:
    """Print the angles in one line, with the chosen joint in brackets."""
    texts = [f"{angle:7.1f}" for angle in angles]
    texts[joint - 1] = f"[{texts[joint - 1]}]"
    print("\r" + "  ".join(texts) + " ", end="", flush=True)


def keys() -> Iterator[str]:
    """Yield each key as it is pressed, and an empty text from time to time."""
    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    tty.setcbreak(terminal)  # no Enter; Ctrl-C still ends the program, and stops the arm
    try:
        while True:
            ready, _, _ = select.select([terminal], [], [], SHOW_SECONDS)
            # Not with sys.stdin: its buffer may hold keys, which select() does not see.
            yield os.read(terminal, 1).decode(errors="replace") if ready else ""
    finally:
        termios.tcsetattr(terminal, termios.TCSADRAIN, before)


if __name__ == "__main__":
    main(sys.argv[1])
