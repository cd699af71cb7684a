"""Export captures to Parquet, CSV, Arrow and MCAP files.

See ``docs/export.md``. :func:`write` runs an :class:`ExportPlan` on one machine.
"""

from __future__ import annotations

from collections.abc import Callable

from cobotwire.capture.export.extras import needed
from cobotwire.capture.export.inputs import Input, Inputs
from cobotwire.capture.export.plan import Editions, ExportPlan, FormatName, Message
from cobotwire.capture.export.report import OutputFile, Report

__all__ = [
    "Editions",
    "ExportPlan",
    "FormatName",
    "Input",
    "Inputs",
    "Message",
    "OutputFile",
    "Report",
    "write",
]


def write(
    plan: ExportPlan, inputs: Inputs, progress: Callable[[int], None] = lambda size: None
) -> Report:
    """Export inputs, one after another; return what was read and written.

    Until everything is complete, files have temporary names; an exception removes them. Memory
    does not depend on the size of the inputs. ``progress`` gets the numbers of stored bytes that
    were read.

    Raises:
        UsageError: the plan cannot be written, an input cannot be opened, a file exists, or a
            package is missing.
        LinkError: an input cannot be read to its end.
        CaptureError: a recording is damaged.
        OutputError: a file cannot be written.
    """
    needed("pyarrow", "arrow", "export")
    # Importing it needs pyarrow.
    from cobotwire.capture.export.running import run

    return run(plan, inputs, progress)
