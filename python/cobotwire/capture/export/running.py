"""Run an export on one machine; :func:`cobotwire.capture.export.write` describes it."""

from __future__ import annotations

from cobotwire.capture.export.inputs import Inputs
from cobotwire.capture.export.opening import Progress
from cobotwire.capture.export.output import Output
from cobotwire.capture.export.plan import ExportPlan
from cobotwire.capture.export.report import Report
from cobotwire.capture.export.sources import Source


def run(plan: ExportPlan, inputs: Inputs, progress: Progress) -> Report:
    """Export inputs, one after another; return what was read and written."""
    report = Report()
    source = Source(plan, report, progress)
    with Output(plan) as output:
        for input in inputs.files:
            for batch in source.batches(input):
                output.write(batch)
        if output.layout.single and not report.rows and len(report.unread) < len(inputs.files):
            output.create_empty(source.empty_schema(output.layout.chosen()[0]))
        report.files = output.publish()
    return report
