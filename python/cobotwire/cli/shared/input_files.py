"""Find the files that arguments name: files, folders and patterns; choose how they are read."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from glob import glob, has_magic
from typing import TypeVar

import click

from cobotwire.capture.byte_source import hex_arguments
from cobotwire.protocol.errors import UsageError

Subcommand = TypeVar("Subcommand", bound=Callable[..., None])
# The formats of files that ``--read-as`` names; ``--raw`` and ``--hex`` are two of them.
FORMATS = (
    *("raw", "hex", "xxd", "hexdump", "od", "python", "socat", "pymycobot", "candump"),
    *("saleae", "sigrok", "pcap", "pcapng-tcp"),
)


def reading_options(subcommand: Subcommand) -> Subcommand:
    """Add the options that choose the format of files."""
    for option in (
        click.option(
            "--tcp-port",
            "ports",
            type=click.IntRange(1, 65535),
            multiple=True,
            metavar="PORT",
            help="The arm's TCP port in a capture of a network; by default 9000 and 4500.",
        ),
        click.option(
            "--read-as",
            "format",
            type=click.Choice(FORMATS),
            help="The format of FILE; else it is detected.",
        ),
        click.option("--hex", "format", flag_value="hex", help="FILE holds hex text."),
        click.option("--raw", "format", flag_value="raw", help="FILE holds raw bytes."),
    ):
        subcommand = option(subcommand)
    return subcommand


def input_files(arguments: Sequence[str]) -> list[str] | None:
    """Return the names of files in the order of the arguments; None if they are bytes in hex.

    A folder means the files directly in it, a pattern those that match, both sorted by name. ``-``
    is standard input.

    Raises:
        UsageError: an argument names no file, or a folder holds none.
    """
    if all(_is_word(argument) for argument in arguments):
        return None
    if "-" in arguments and len(arguments) > 1:
        message = "- is standard input; it cannot be combined with files or bytes"
        raise UsageError("FILE", "-", message=message)
    return [name for argument in arguments for name in _files(argument)]


def _is_word(argument: str) -> bool:
    """Return whether an argument is bytes in hex, or may be misspelt bytes in hex."""
    if hex_arguments((argument,)) is not None:
        return True
    return argument != "-" and not os.path.exists(argument) and not _looks_like_file(argument)


def _looks_like_file(argument: str) -> bool:
    return "." in argument or os.sep in argument or has_magic(argument)


def _files(argument: str) -> list[str]:
    if os.path.isdir(argument):
        found = sorted(entry.path for entry in os.scandir(argument) if _is_shown(entry))
        if not found:
            raise UsageError("FILE", argument, message=f"{argument}: the folder holds no file")
        return [_as_file(name) for name in found]
    if has_magic(argument) and not os.path.exists(argument):
        found = sorted(name for name in glob(argument, recursive=True) if os.path.isfile(name))
        if not found:
            raise UsageError("FILE", argument, message=f"{argument}: no such file")
        return [_as_file(name) for name in found]
    if argument != "-" and not os.path.exists(argument):
        raise UsageError("FILE", argument, message=f"{argument}: no such file")
    return [argument]


def _is_shown(entry: os.DirEntry[str]) -> bool:
    return entry.is_file() and not entry.name.startswith(".")


def _as_file(name: str) -> str:
    """Return a name that cannot be mistaken for bytes in hex."""
    return name if hex_arguments((name,)) is None else os.path.join(os.curdir, name)
