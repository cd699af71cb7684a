"""The options of a run, as a report keeps them, so that the run can be repeated from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.permissions import Permissions
from cobotwire.conformance.device.requester import Timing
from cobotwire.conformance.device.tester import Tester
from cobotwire.conformance.options import Options
from cobotwire.conformance.statement import Statement
from cobotwire.conformance.workspace import parse_workspace, words
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table


@dataclass(frozen=True, slots=True)
class RunOptions(Options):
    """What a caller chooses for a run, in the words of the command line.

    ``linger`` is in milliseconds, ``max_speed`` in percent.
    """

    kind = "device"

    allow: str = ""
    max_speed: int | None = None
    workspace: str | None = None
    repeat: int = 1
    retries: int = 0
    optional: str = ""
    address: str | None = None
    linger: float | None = None
    baudrate: int | None = None

    def completed(self, ixit: Mapping[str, Any]) -> RunOptions:
        """Return the options; a statement gives those that the caller did not choose."""
        return replace(self, **{n: v for n, v in ixit.items() if getattr(self, n) is None})

    def validate(self, table: Table) -> None:
        """Check the options before a port is opened.

        Raises:
            UsageError: an option is not possible with the edition.
        """
        for name, least in (("repeat", 1), ("retries", 0)):
            if getattr(self, name) < least:
                raise UsageError(name, getattr(self, name), f"a whole number from {least}")
        self._permissions(table)
        self._optional(table)

    def tester(
        self,
        connection: DeviceConnection,
        table: Table,
        sources: Mapping[str, str] | None = None,
        statement: Statement | None = None,
        lacking: Mapping[str, str] | None = None,
    ) -> Tester:
        """Return the tester for a connection; nothing is sent.

        Raises:
            UsageError: an option is not possible with the edition.
        """
        self.validate(table)
        number = self.address is not None and self.address.isascii() and self.address.isdigit()
        tester = Tester(
            connection,
            table,
            permissions=self._permissions(table),
            sources=sources,
            timing=Timing() if self.linger is None else Timing(linger=self.linger / 1000),
            repeat=self.repeat,
            retries=self.retries,
            optional=self._optional(table),
            statement=statement,
            lacking=lacking,
            address=int(self.address) if number and self.address else self.address,
        )
        tester.report.options = self.for_report()
        return tester

    def _permissions(self, table: Table) -> Permissions:
        space = None if self.workspace is None else parse_workspace(self.workspace, table.joints)
        return Permissions.of(
            words(self.allow),
            joints=table.joints,
            max_speed=self.max_speed,
            workspace=space,
        )

    def _optional(self, table: Table) -> frozenset[str]:
        return frozenset(table.command(name).name for name in words(self.optional))
