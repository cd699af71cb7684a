"""The end goes where it is sent, along or about one axis."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ACKNOWLEDGED, ARRIVES, SILENT
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.jogging import nearby
from cobotwire.table import Command, Table


def is_for_an_axis(table: Table, command: Command) -> bool:
    """Whether a command sends the end somewhere along one axis."""
    return command.role == "coordinate target"


@trial(ARRIVES, SILENT, ACKNOWLEDGED, of=is_for_an_axis)
def to_coordinate(case: Case) -> None:
    """A little way along or about each axis; the other coordinates stay."""
    nearby(case, case.command.request[0].fields[0], absolute=True)
