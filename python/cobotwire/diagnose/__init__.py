"""Diagnose noise: servo packets, firmware text, reboots, echoes, damaged frames.

:class:`Diagnoser` takes the events of a framer, and returns frames and findings. It does no I/O.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cobotwire.diagnose.diagnoser import Diagnoser as Diagnoser
    from cobotwire.diagnose.diagnoser import Item as Item
    from cobotwire.diagnose.findings import Finding as Finding
    from cobotwire.diagnose.findings import Span as Span
    from cobotwire.diagnose.registry import *  # noqa: F403 - it lists the classes of noise
    from cobotwire.diagnose.summary import Summary as Summary
    from cobotwire.diagnose.summary import summarize as summarize
else:
    # Imported when they are first used: reading frames needs none of them.
    from cobotwire.protocol.lazy import lazy_names

    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".diagnoser": ["Diagnoser", "Item"],
            ".findings": ["Finding", "Span"],
            ".summary": ["Summary", "summarize"],
        },
        (".registry",),
    )
