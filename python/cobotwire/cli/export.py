"""``cobotwire export``: write captures to Parquet, CSV, Arrow and MCAP files."""

from __future__ import annotations

import json
import sys
from typing import get_args

import click

from cobotwire.capture import archive
from cobotwire.capture.archive import ENGINES, EngineName, choose_engine
from cobotwire.capture.export import ExportPlan, FormatName, Inputs, write
from cobotwire.capture.export.formats import format_of
from cobotwire.capture.export.plan import Compression, Key
from cobotwire.capture.export.times import time_ns
from cobotwire.cli.shared.completers import complete_commands
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.exit_codes import USAGE
from cobotwire.cli.shared.export_report import report_lines
from cobotwire.cli.shared.input_files import reading_options
from cobotwire.cli.shared.output import print_line
from cobotwire.cli.shared.progress_bar import progress_bar
from cobotwire.cli.shared.recordings import notify
from cobotwire.codec.interface import Listening
from cobotwire.inspect.exporting import InstalledEditions


def _time(context: click.Context, option: click.Parameter, value: str | None) -> int | None:
    return None if value is None else time_ns(value, option.opts[0])


def _keys(context: click.Context, option: click.Parameter, value: str) -> tuple[str, ...]:
    return tuple(value.split(",")) if value else ()


@click.command()
@click.argument("input", nargs=-1, required=True, type=click.Path(), metavar="INPUT...")
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(),
    metavar="OUT",
    help="A folder, or a single file, such as all.mcap or angles.parquet.",
)
@click.option(
    "--as",
    "written_as",
    type=click.Choice(get_args(FormatName)),
    help="The format; by default chosen by OUT's file extension, else Parquet.",
)
@click.option(
    "--command",
    "commands",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_commands,
    help="Write only this command. May be repeated.",
)
@click.option(
    "--direction",
    type=click.Choice(["request", "reply", "both"]),
    default="both",
    show_default=True,
    help="Which messages to write; also which messages raw bytes hold.",
)
@reading_options
@click.option(
    "--from",
    "begin_ns",
    callback=_time,
    metavar="TIME",
    help="Write messages from this time (UTC).",
)
@click.option(
    "--to", "end_ns", callback=_time, metavar="TIME", help="Write messages before this time (UTC)."
)
@click.option("--wide", is_flag=True, help="Give each number of a field a column of its own.")
@click.option(
    "--gap",
    type=click.FloatRange(min=0),
    default=1.0,
    show_default=True,
    metavar="SECONDS",
    help="Count the pauses of a recording that are longer than this.",
)
@click.option(
    "--partition",
    default="",
    callback=_keys,
    metavar="KEYS",
    help="Sort files into folders by any of robot, command and day, with commas between them.",
)
@click.option(
    "--compression",
    type=click.Choice(get_args(Compression)),
    default="zstd",
    show_default=True,
    help="How Parquet and Arrow files are compressed.",
)
@click.option(
    "--engine",
    type=click.Choice(ENGINES),
    help="Export with many workers: threads, or the processes of a Dask cluster.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="The scheduler of the Dask cluster; without it, a cluster is started here.",
)
@click.option(
    "--workers",
    type=click.IntRange(min=1),
    metavar="N",
    help="How many threads or processes to start; by default one for each processor.",
)
@click.option("--overwrite", is_flag=True, help="Replace files that exist.")
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option("--quiet", is_flag=True, help="Print no report and no progress.")
@uses_edition
def export(
    edition: str,
    input: tuple[str, ...],
    output: str,
    format: str | None,
    ports: tuple[int, ...],
    written_as: FormatName | None,
    commands: tuple[str, ...],
    direction: Listening,
    begin_ns: int | None,
    end_ns: int | None,
    wide: bool,
    gap: float,
    partition: tuple[Key, ...],
    compression: Compression,
    engine: EngineName | None,
    scheduler: str | None,
    workers: int | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Write the messages of captures to files that data tools read.

    INPUT is a recording (pcapng), raw bytes, or what other programs wrote, as for cobotwire decode:
    a file, a folder, a pattern such as 'mon*.pcapng', an fsspec URL such as s3://bucket/day/, or -
    for standard input. Files that end in .gz or .zst are decompressed.

    By default, each message has a file in the folder OUT: get_angles.reply.parquet. An MCAP file
    holds all messages, and what Foxglove draws: the states of the joints, and the pose of the end
    of the arm.

    \b
      cobotwire export arm.pcapng -o out/
      cobotwire export captures/ -o angles.parquet --command get_angles --direction reply
      cobotwire export 'captures/*.pcapng.zst' -o lake/ --partition robot,command,day
      cobotwire export arm.pcapng -o arm.mcap --from 2026-11-23T14:00 --to 2026-11-23T15:00

    With --engine, OUT is a folder or an fsspec URL, and each message has several files: one for
    each 64 MiB of raw bytes, and one for each recording: get_angles.reply-00012.parquet.

    \b
      cobotwire export s3://lab/raw/ -o s3://lab/lake/ --engine dask --scheduler tcp://head:8786

    The report counts rows, noise, rejected frames, gaps, and inputs that end too early. An export
    that is interrupted leaves no file under its final name.

    Exit codes: 0 everything is written, and the inputs are complete and hold only legal frames;
    1 everything that could be read is written, but an input holds noise or rejected frames, ends
    too early or is not read, or no message was chosen; 2 wrong usage, or the only input cannot be
    read; 3 reading an input failed; 8 a file cannot be written.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    plan = ExportPlan(
        output,
        InstalledEditions(edition),
        written_as or format_of(output) or "parquet",
        commands,
        direction,
        begin_ns,
        end_ns,
        wide,
        round(gap * 1e9),
        partition,
        compression,
        overwrite,
        format or "",
        ports,
    )
    chosen = choose_engine(engine, scheduler, workers)
    inputs = Inputs.find(input)
    with progress_bar("exporting", inputs.size, hidden=quiet) as advance:
        if chosen is None:
            report = write(plan, inputs, advance)
        else:
            report = archive.export(plan, inputs, chosen, progress=advance)
    if report.unread and len(inputs.files) == 1:
        notify(report.unread[0])
        sys.exit(USAGE)
    if as_json:
        print_line(json.dumps(report.as_dict()))
    elif not quiet:
        click.echo("\n".join(report_lines(report)), err=True)
    sys.exit(0 if report.clean and report.files else 1)
