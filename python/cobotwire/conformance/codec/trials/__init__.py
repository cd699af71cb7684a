"""What every codec of an edition is asked, derived from the edition's table.

:func:`derive` is the one place: a runner asks these questions, and vectors for other languages are
the same trials in a file.
"""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.codec.interface import Codec
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.trials import frames, malformed
from cobotwire.conformance.codec.trials.streams import streams
from cobotwire.conformance.codec.trials.trial import Json, Trial
from cobotwire.table import Table

__all__ = ["Json", "Trial", "derive"]

KINDS = (
    frames.encoding,
    frames.refusing_values,
    frames.decoding,
    frames.refusing_numbers,
    malformed.malformed,
    malformed.every_id,
    malformed.shared,
    malformed.of_another,
    streams,
)


def derive(table: Table) -> Iterator[Trial]:
    """Every trial of an edition, in an order that does not change; no two have the same name."""
    codec: Codec = ReferenceCodec(table)
    seen: dict[str, Trial] = {}
    for kind in KINDS:
        for trial in kind(codec):
            first = seen.setdefault(trial.name, trial)
            if first is trial:
                yield trial
            else:
                assert first.ask == trial.ask, f"{trial.name} names two trials"
