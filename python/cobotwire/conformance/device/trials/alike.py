"""What shows only when everything was sent."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ALIKE
from cobotwire.conformance.device.trial import Case, trial


@trial(ALIKE, of=None)
def alike(case: Case) -> None:
    """All orders that were sent until now."""
    heard = case.bench.acknowledged
    silent = [name for name, said in heard.items() if not said]
    if len(heard) > 1:
        reason = f"some commands were acknowledged, but not {', '.join(silent)}"
        case.expect(ALIKE, not silent or len(silent) == len(heard), reason)
