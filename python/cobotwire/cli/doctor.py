"""``cobotwire doctor``: what ails an arm or its line, and what to do about it."""

from __future__ import annotations

import json
import sys
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.call import in_words, plain
from cobotwire.cli.link import link_options, linked
from cobotwire.driver import Driver
from cobotwire.errors import LinkError
from cobotwire.health import Examination, Report
from cobotwire.health.examination import unopened
from cobotwire.session import RetryPolicy

MOST = 10_000
NO_LINK = 3


@click.command()
@click.argument("port", metavar="URL")
@link_options
@click.option("--timeout", type=float, default=0.5, show_default=True, help="Seconds to wait.")
@click.option(
    "--count",
    type=click.IntRange(1, MOST),
    default=20,
    show_default=True,
    help="How many round trips are timed.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.pass_obj
def doctor(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    timeout: float,
    count: int,
    as_json: bool,
) -> None:
    """Examine the arm at URL: a port, or a URL such as socket://host:9000.

    Only harmless queries are asked, each once: nothing moves, nothing is set. Told are the times of
    the round trips, what else came over the line, and what to do about it.

    Exit code 0 if it is healthy, 1 if not, 3 if there is no link.
    """
    package = editions.load(edition)
    table = package.TABLE
    report, lost = unopened(port, table.edition), False
    try:
        with linked(port, table, baudrate, record) as link:
            # Asked once each: what is lost shall be seen.
            arm: Driver = package.CLIENT(link, timeout=timeout, retry=RetryPolicy(tries=1))
            examination = Examination(arm, link, codecs.load(table))
            report = examination.report
            examination.run(count)
    except LinkError as error:
        lost = True
        report.lost(error)
    click.echo(json.dumps(_as_json(report), indent=1) if as_json else "\n".join(_lines(report)))
    sys.exit(NO_LINK if lost else int(not report.healthy))


def _lines(report: Report) -> list[str]:
    lines = [f"{report.url}: edition {report.edition}"]
    lines += [f"  {name:<14} {in_words(value)}" for name, value in report.answers.items()]
    if report.asked:
        lines.append(f"  {report.answered} of {report.asked} questions answered")
    if report.round_trip is not None:
        low, middle, high = (1e3 * seconds for seconds in report.round_trip)
        lines.append(f"  round trip {middle:.1f} ms ({low:.1f} to {high:.1f})")
    if report.latency_timer_ms is not None:
        lines.append(f"  latency timer {report.latency_timer_ms} ms")
    if report.noise:
        lines.append(f"  {report.noise} bytes of noise: {report.diagnosis}")
    for complaint in report.complaints:
        mark = "!" if complaint.grave else "-"
        lines += [f"{mark} {complaint.kind}: {complaint.says}", f"    {complaint.advice}"]
    if report.healthy:
        lines.append("healthy")
    return lines


def _as_json(report: Report) -> dict[str, Any]:
    said = {name: getattr(report, name) for name in report.__dataclass_fields__}
    said["answers"] = {name: plain(value) for name, value in report.answers.items()}
    times = report.round_trip
    said["round_trip"] = None if times is None else times._asdict()
    said["complaints"] = [complaint._asdict() for complaint in report.complaints]
    return {"healthy": report.healthy, **said}
