"""``python -m cobotwire.pymycobot script.py``: run a program of the maker's library."""

from __future__ import annotations

import argparse
import sys

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.running import run_program

parser = argparse.ArgumentParser(prog="python -m cobotwire.pymycobot", description=__doc__)
parser.add_argument("--errors", choices=("raise", "return"), default="raise")
parser.add_argument("script")
parser.add_argument("arguments", nargs=argparse.REMAINDER)


def main() -> int:
    """Run the program that the command line names."""
    given = parser.parse_args()
    try:
        return run_program(given.script, given.arguments, given.errors)
    except UsageError as error:
        parser.error(str(error))


if __name__ == "__main__":
    sys.exit(main())
