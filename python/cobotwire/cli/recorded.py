"""What the verbs that read recordings have in common."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import lru_cache

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader, is_capture, read
from cobotwire.cli.source import hex_words
from cobotwire.codec.interface import Codec

ARROWS = {"sent": ">", "heard": "<", "unknown": "?"}


def capture_in(words: Sequence[str]) -> CaptureReader | None:
    """The recording that the one word names; None: it is something else."""
    # What is hex is not looked for among the files here; a pipe that was looked into is not whole.
    if len(words) != 1 or hex_words(words) is not None or not os.path.isfile(words[0]):
        return None
    try:
        with open(words[0], "rb") as file:
            first = file.read(12)
    except OSError:
        return None
    return read(words[0]) if is_capture(first) else None


def codec_of(capture: CaptureReader, line: int, edition: str) -> Codec:
    """By what the packets of a line are read: the recording's edition, as far as it is ours."""
    return _loaded(capture.interfaces[line].edition, edition)


@lru_cache
def _loaded(recorded: str, edition: str) -> Codec:
    name = recorded if recorded in editions.names() else edition
    return codecs.load(editions.load(name).TABLE)


def tell_the_end(capture: CaptureReader) -> None:
    """That something may be missing is said where it does not mix with what is there."""
    if capture.truncated_at is not None:
        whole = f"what comes before byte {capture.truncated_at} is whole"
        click.echo(f"cobotwire: {capture.name} ends in the middle of a packet; {whole}", err=True)
    elif not capture.finished:
        click.echo(f"cobotwire: the recording {capture.name} was not ended in order", err=True)
