"""``cobotwire doctor``: find what is wrong with an arm or its port, and say what to do."""

from __future__ import annotations

import json
import sys
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.shared.arm_options import address_option, arm_options, open_arm, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.exit_codes import LINK_FAILED
from cobotwire.cli.shared.output import fold, format_result
from cobotwire.client import Client
from cobotwire.inspect import Doctor, Report
from cobotwire.protocol.errors import LinkError
from cobotwire.protocol.json_values import as_json_value
from cobotwire.session import RetryPolicy

MOST = 10_000


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@arm_options
@address_option
@click.option(
    "--timeout", type=float, default=0.5, show_default=True, help="Seconds to wait for a reply."
)
@click.option(
    "--count",
    type=click.IntRange(1, MOST),
    default=20,
    show_default=True,
    help="How many round trips to measure.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@uses_edition
def doctor(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    address: str | None,
    timeout: float,
    count: int,
    as_json: bool,
) -> None:
    """Examine the arm at URL: a serial port, or a URL such as socket://host:9000.

    Only harmless queries are sent: nothing moves, and nothing is set. The report holds the arm's
    state, the times of the round trips, a diagnosis of all other traffic, and advice for each
    problem.

    Exit codes: 0 healthy; 1 there is a problem; 3 the port failed.
    """
    package = editions.load(edition)
    report, port_failed = Report(port, package.TABLE.edition), False
    try:
        # Without retries, so that the report shows lost replies.
        once = RetryPolicy(attempts=1)
        with open_arm(port, package.TABLE, baudrate, record) as transport:
            options: dict[str, Any] = {"timeout": timeout, "retry": once, "on_error": "leave"}
            to = None if address is None else parse_address(address)
            arm: Client = package.CLIENT(transport, address=to, **options)
            with arm:
                Doctor(arm, transport, codecs.load(package.TABLE), report).examine(count)
    except LinkError as error:
        port_failed = True
        report.add_port_failure(error)
    click.echo(
        json.dumps(_as_json(report), indent=1) if as_json else fold("\n".join(_lines(report)))
    )
    sys.exit(LINK_FAILED if port_failed else int(not report.healthy))


def _lines(report: Report) -> list[str]:
    # If the port was never open, the edition is unknown, and the error says what to do.
    lines = [f"{report.url}: edition {report.edition}"] if report.kind else []
    width = max(map(len, report.values), default=0)
    lines += [f"  {name:<{width}} {format_result(value)}" for name, value in report.values.items()]
    if report.requests:
        lines.append(f"  {report.replies} replies to {report.requests} requests")
    if report.round_trip is not None:
        low, middle, high = (1e3 * seconds for seconds in report.round_trip)
        lines.append(f"  round trip {middle:.1f} ms ({low:.1f} to {high:.1f})")
    if report.latency_timer_ms is not None:
        lines.append(f"  latency timer {report.latency_timer_ms} ms")
    if report.noise:
        lines.append(f"  {report.noise} bytes of noise: {report.diagnosis}")
    for problem in report.problems:
        mark = "!" if problem.serious else "-"
        lines += [f"{mark} {problem.kind}: {problem.text}"]
        lines += [f"    {problem.advice}"] if problem.advice else []
    if report.healthy:
        lines.append("healthy")
    return lines


def _as_json(report: Report) -> dict[str, Any]:
    content = {name: getattr(report, name) for name in report.__dataclass_fields__}
    content["values"] = {name: as_json_value(value) for name, value in report.values.items()}
    times = report.round_trip
    content["round_trip"] = None if times is None else times._asdict()
    content["problems"] = [problem._asdict() for problem in report.problems]
    return {"healthy": report.healthy, **content}
