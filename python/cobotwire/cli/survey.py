"""``cobotwire survey``: find out which facts of an edition a real arm confirms and contradicts."""

from __future__ import annotations

import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any, Literal

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import Recording
from cobotwire.capture.export.atomic_file import AtomicFile
from cobotwire.capture.streams import packets_of_interface
from cobotwire.cli.shared.any_key import interrupted_by_any_key
from cobotwire.cli.shared.arm_options import address_option, baudrate_option, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.exit_codes import INTERRUPTED, LINK_FAILED
from cobotwire.cli.shared.output import fold, report_written
from cobotwire.cli.shared.progress_bar import step_progress
from cobotwire.cli.shared.recordings import open_recording, warn_if_incomplete
from cobotwire.cli.shared.subject_connection import Lacking, Subject, connected
from cobotwire.conformance.device import DeviceConnection
from cobotwire.conformance.sources import spec_lines
from cobotwire.conformance.survey import Survey, read_survey, survey_file
from cobotwire.conformance.survey.file import RECORDING, content_of, continued
from cobotwire.conformance.survey.recorded import RecordedTransport
from cobotwire.inspect.captured import codec_of_interface
from cobotwire.inspect.seal import load_signer
from cobotwire.protocol.addresses import check_one_moves
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.table import Table
from cobotwire.transport.serial.ports import leads_to_device
from cobotwire.transport.tapped import tapped

WORKSPACE = (
    "The arm will make a few small slow motions, up to 5 degrees from where each joint is; if a "
    "fact of the edition is wrong, one may be larger. Any key stops the arm. An arm that is off is "
    "switched on, and off again at the end; then it sinks. Is the workspace clear, the emergency "
    "stop within reach, the gripper empty, and the arm supported?"
)

NOT_SHOWN = (
    "{} may be a program, so the survey counts as one of a simulated arm and is no "
    "evidence; if it is a real arm, press Ctrl-C and add --real-arm"
)

INCOMPLETE = (
    "the recording lacks requests of the survey, such as calculations with the arm's position; "
    "--continue sends them to the arm"
)
LATEST_NS = 2**63
VERDICTS = ("confirmed", "contradicted", "not seen")


@click.command()
@click.argument("port", metavar="URL", required=False, shell_complete=complete_ports)
@click.option("-o", "--output", type=click.Path(), required=True, help="The file to write, a zip.")
@click.option("--robot", default="", help="What robot it is: the words on its label.")
@click.option("--settings", is_flag=True, help="Store some settings, too, and restore them.")
@click.option("--allow-motion", is_flag=True, help="Make a few small slow motions, too.")
@click.option("--yes-workspace-is-clear", is_flag=True, help="Do not ask before the motions.")
@click.option("--continue", "resume", is_flag=True, help="Continue the interrupted survey of -o.")
@click.option("--simulated", is_flag=True, help="Survey a simulated arm instead of URL.")
@click.option(
    "--real-arm", is_flag=True, help="State that the arm is a real one, not a simulated one."
)
@click.option(
    "--from",
    "recording",
    type=click.Path(),
    metavar="FILE",
    help="Evaluate the survey that the page live/ recorded in FILE; nothing is sent.",
)
@click.option(
    "--sign", type=click.Path(), metavar="KEY", help="Sign the file with this key (Ed25519)."
)
@click.option("--json", "as_json", is_flag=True, help="Print what was found as JSON.")
@baudrate_option
@address_option
@uses_edition
def survey(
    edition: str,
    port: str | None,
    output: str,
    robot: str,
    settings: bool,
    allow_motion: bool,
    yes_workspace_is_clear: bool,
    resume: bool,
    simulated: bool,
    real_arm: bool,
    recording: str | None,
    sign: str | None,
    as_json: bool,
    baudrate: int | None,
    address: str | None,
) -> None:
    """Survey the arm at URL: which facts of the edition it confirms, and which it contradicts.

    It takes at most ten minutes. At first only queries are sent, and what the arm reports is
    compared: encoders with angles, angles with coordinates, targets with readings. --settings
    also changes settings that a power cycle resets, and restores them. --allow-motion also moves
    the arm, after you have confirmed that; any key stops it. If the arm is off, it is switched on,
    and off again at the end: then it sinks.

    A USB port shows that the arm is a real one. For another port, such as socket://HOST:PORT, and
    for a recording, add --real-arm if the arm is real; without it, the survey counts as one of a
    simulated arm.

    The file holds the recording and each fact with its bytes. It names no port, host or user;
    passwords are not requested, and serial numbers are replaced by their hash. If the survey is
    interrupted, the same command with --continue continues it.

    Exit codes: 0 nothing is contradicted; 1 a fact is contradicted, or the arm has another edition;
    3 the port failed; 130 interrupted.
    """
    recorded = None
    if recording is not None:
        if settings or allow_motion or simulated or port is not None:
            message = (
                "--from evaluates a recording: omit URL, --simulated, --settings and --allow-motion"
            )
            raise UsageError("from", message=message)
        edition, recorded = _recorded(recording, edition)
    table = editions.load(edition).TABLE
    subject = Subject(port, None, None, simulated, baudrate, recorded)
    subject.validate()
    if not (simulated or real_arm or (port is not None and leads_to_device(port))):
        simulated = True
        where = "what replies at this port" if recorded is None else "the recorded arm"
        click.echo(fold(NOT_SHOWN.format(where), err=True), err=True)
    to = None if address is None else parse_address(address)
    if allow_motion:
        check_one_moves(table, to)
    signer = None if sign is None else load_signer(sign)
    earlier = _earlier(output, table, to) if resume else None
    if not resume and Path(output).exists():
        message = f"{output} exists already; --continue continues an interrupted survey"
        raise UsageError("output", output, message=message)
    if allow_motion and not yes_workspace_is_clear:
        _confirm_workspace()
    file = AtomicFile(Path(output), overwrite=resume)
    began = datetime.now(UTC) if recorded is None else recorded.began
    try:
        with tempfile.TemporaryDirectory(prefix="cobotwire-") as folder:
            path = Path(folder) / RECORDING
            found, stopped = _run(
                table, edition, subject, path, earlier, settings, allow_motion, to
            )
            if recorded is not None and recorded.missing:
                found.finished = False
                found.obstacle = found.obstacle or INCOMPLETE
            content = content_of(found, edition, robot, simulated=simulated, began=began)
            traffic = path.read_bytes()
        if earlier is not None:
            content, traffic = continued(earlier, content, traffic)
        click.echo(
            json.dumps(content, indent=1) if as_json else fold("\n".join(_lines(found, content)))
        )
        if found.other:
            # The file says nothing about this edition, so it is not kept.
            sys.exit(1)
        file.file.write(survey_file(content, traffic, signer))
        file.publish()
    finally:
        file.discard()
    report_written(output)
    sys.exit(stopped or int(any(f["verdict"] == "contradicted" for f in content["facts"])))


def _earlier(path: str, table: Table, to: int | str | None) -> tuple[dict[str, Any], bytes]:
    """Return the content and the recording of the survey to continue, if it is of this device."""
    content, recording = read_survey(path)
    if content.get("edition") != table.edition:
        message = f"{path} is the survey of edition {content.get('edition')!r}: add --edition"
        raise UsageError("continue", path, message=message)
    address = content.get("address")
    if address != to:
        option = "without --address" if address is None else f"with --address {address!r}"
        message = f"{path} is the survey of another device: continue it {option}"
        raise UsageError("address", to, message=message)
    return content, recording


def _confirm_workspace() -> None:
    if not sys.stdin.isatty():
        message = "--allow-motion needs a terminal for its question, or --yes-workspace-is-clear"
        raise UsageError("allow_motion", message=message)
    click.confirm(fold(WORKSPACE, err=True), abort=True, err=True)


def _recorded(path: str, edition: str) -> tuple[str, RecordedTransport]:
    """Return the edition of a recording, and a transport that replays its first interface."""
    with open_recording(path) as capture:
        packets = list(packets_of_interface(capture, 0))
        codec = codec_of_interface(capture, 0, edition)
        warn_if_incomplete(capture)
    if not any(packet.direction == "sent" for packet in packets):
        message = f"{path} holds no request, so there is nothing to evaluate"
        raise UsageError("from", path, message=message)
    if not all(0 <= packet.time_ns < LATEST_NS for packet in packets):
        raise UsageError("from", path, message=f"{path} has times before 1970 or after 2262")
    if codec.table.edition in editions.names():
        edition = codec.table.edition
    return edition, RecordedTransport(packets, codec)


def _run(
    table: Table,
    edition: str,
    subject: Subject,
    path: Path,
    earlier: tuple[dict[str, Any], bytes] | None,
    settings: bool,
    motion: bool,
    address: int | str | None,
) -> tuple[Survey, int]:
    """Return the survey, and the exit code if it was interrupted; 0 if not."""
    tap = _Tap(Recording(path, codecs.load(table), baudrate=subject.baudrate or table.baudrate))
    with connected(table, subject, Lacking(table)) as opened:
        transport = tapped(opened.transport, tap)
        found = Survey(
            DeviceConnection(transport, opened.clock, opened.name),
            table,
            package=edition,
            settings=settings,
            motion=motion,
            earlier=earlier and earlier[0],
            sources=spec_lines(edition),
            on_private=tap.hide,
            address=address,
        )
        try:
            with step_progress() as show, interrupted_by_any_key(motion):
                found.run(show)
        except KeyboardInterrupt:
            click.echo("interrupted: the arm was stopped, and its settings were restored", err=True)
            return found, INTERRUPTED
        except LinkError as error:
            click.echo(fold(f"cobotwire: {error}", err=True), err=True)
            return found, LINK_FAILED
        finally:
            tap.recording.close()
    return found, 0


class _Tap:
    """Records all traffic.

    While the traffic is private, received bytes are replaced by their hash.
    """

    def __init__(self, recording: Recording) -> None:
        self.recording, self._hidden = recording, False

    def hide(self, hidden: bool) -> None:
        """Start or stop replacing received bytes by their hash."""
        self._hidden = hidden

    def __call__(self, direction: Literal["sent", "received"], data: bytes, at: float) -> None:
        if self._hidden and direction == "received":
            data = sha256(data).digest()
        self.recording.record(direction, data, at)


def _lines(found: Survey, content: dict[str, Any]) -> Iterator[str]:
    """Yield what was found, and what the file holds of the arm and its owner."""
    firmware = ", ".join(f"{name} {value}" for name, value in found.firmware.items())
    yield f"edition {found.table.edition}{firmware and f'; {firmware}'}"
    yield from (f"! {each}" for each in found.contradicted)
    yield from (f"- {question}" for question in found.questions)
    if found.obstacle:
        yield f"{'!' if found.other else '-'} {found.obstacle}"
    if found.left_out and not found.other:
        yield f"- still to run: --continue {' '.join(found.left_out)}"
    verdicts = Counter(fact["verdict"] for fact in content["facts"])
    simulated = "; of a simulated arm" if content["simulated"] else ""
    yield "facts: " + ", ".join(f"{verdicts[v]} {v}" for v in VERDICTS) + simulated
    hashed = ", ".join(found.hashed)
    yield "the file names no port, host or user; " + (
        f"the replies to {hashed} are hashed" if hashed else "no serial number was reported"
    )
