"""``cobotwire identify``: find out which edition and firmware an arm has."""

from __future__ import annotations

import json
import sys
from typing import Any

import click

from cobotwire.cli.shared.arm_options import baudrate_option
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.exit_codes import NO_REPLY
from cobotwire.cli.shared.output import fold, format_result
from cobotwire.inspect.evidence import Evidence
from cobotwire.inspect.identification import Identification
from cobotwire.inspect.identification import identify as identify_arm
from cobotwire.protocol.json_values import as_json_value


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@baudrate_option
@click.option(
    "--timeout", type=float, default=0.5, show_default=True, help="Seconds to wait for a reply."
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def identify(port: str, baudrate: int | None, timeout: float, as_json: bool) -> None:
    """Find out which edition and firmware the arm at URL has; print the evidence.

    A few harmless queries are sent: nothing moves, and nothing is set.

    Exit codes: 0 the edition is known; 1 an arm replied, but its edition is not known, or what it
    reports contradicts the edition; 3 the port failed; 4 no reply.
    """
    found = identify_arm(port, baudrate=baudrate, timeout=timeout)
    click.echo(json.dumps(_as_json(found), indent=1) if as_json else fold("\n".join(_lines(found))))
    if not found.edition or found.doubts:
        sys.exit(1 if found.replied else NO_REPLY)


def _lines(found: Identification) -> list[str]:
    what = f"edition {found.edition}" if found.edition else "the edition is not known"
    if not found.edition and found.candidates:
        what += f"; its replies allow {', '.join(found.candidates)}"
    firmware = f", firmware {found.firmware}" if found.firmware else ""
    return [
        f"{found.url}: {what}{firmware}",
        *map(_line, found.evidence),
        *(f"! {doubt}" for doubt in found.doubts),
    ]


def _line(evidence: Evidence) -> str:
    text = f"replied {format_result(evidence.result)}" if evidence.replied else evidence.text
    return f"  {evidence.query:<22} {text} ({evidence.shows})"


def _as_json(found: Identification) -> dict[str, Any]:
    evidence = [{**each._asdict(), "result": as_json_value(each.result)} for each in found.evidence]
    return {**found._asdict(), "evidence": evidence}
