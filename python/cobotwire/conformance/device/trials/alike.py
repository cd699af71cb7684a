"""What shows only when everything was sent."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ALIKE
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.trial import Case, trial


@trial(ALIKE, of=None)
def alike(case: Case) -> None:
    """All orders that were sent until now."""
    if not any(command.ack for command in case.bench.table.commands):
        case.without(ALIKE)
    heard = case.bench.acknowledged
    silent = [name for name, said in heard.items() if not said]
    if len(heard) < 2:
        raise Unsupported("fewer than two orders were sent")
    reason = f"some commands were acknowledged, but not {', '.join(silent)}"
    case.expect(ALIKE, not silent or len(silent) == len(heard), reason)
