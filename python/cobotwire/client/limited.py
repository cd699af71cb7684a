"""Refuse requests that exceed limits which the ranges of a table cannot state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.kinematics import coords_of, geometry_of
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.limits import AXES, Limits
from cobotwire.protocol.refusals import frame_queries, refusals
from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Address, Command
from cobotwire.session.request import EncodedRequest, RequestEncoder


class LimitedEncoder(RequestEncoder):
    """Encodes requests that stay within limits, and refuses the others."""

    def __init__(self, codec: Codec, address: Address | None, limits: Limits) -> None:
        """Store a codec; its table already has the ranges of ``limits``."""
        super().__init__(codec, address)
        self._refused = refusals(codec.table, limits)
        self._workspace = limits.workspace
        self._geometry = geometry_of(codec.table)
        # Those that are not answered yet. Nobody may change the frame through this client.
        self._frame_queries = () if self._workspace is None else frame_queries(codec.table)

    def encode(
        self,
        name: str,
        values: Sequence[Any],
        text_values: Mapping[str, str] | None = None,
        variant: int | None = None,
    ) -> EncodedRequest:
        """Validate and encode a request by its command's name, as any encoder does.

        Raises:
            UsageError: also: the command could exceed the limits, or would leave the workspace.
        """
        encoded = super().encode(name, values, text_values, variant)
        if self._workspace is not None and encoded.command.role == "joint targets":
            self._check_end(encoded)
        return encoded

    def queries_before(self, request: EncodedRequest) -> Sequence[Command]:
        """Return the queries of the frame before the first target in coordinates."""
        targets = ("coordinate targets", "coordinate target")
        return self._frame_queries if request.command.role in targets else ()

    def accept_frame(self) -> None:
        """Record that the arm has reported 0 to each of these queries."""
        self._frame_queries = ()

    def _command(self, name: str) -> tuple[Command, bool]:
        if why := self._refused.get(name):
            raise UsageError("command", name, message=why)
        return super()._command(name)

    def _check_end(self, request: EncodedRequest) -> None:
        """Check where the arm would be with its joints at the angles of a frame.

        Raises:
            UsageError: the end of the arm would be outside of the workspace.
        """
        command = request.command
        assert self._workspace is not None, "there is something to check"
        assert self._geometry is not None, "without it the command is refused"
        fields = self._codec.decode("request", request.frame, of=command.name).fields
        variant = command.request[0]
        angles = fields[variant.fields[row_index(variant)].name]
        end = coords_of(self._geometry, angles)
        for axis, at, allowed in zip(AXES, end, self._workspace):
            if allowed is not None and not allowed[0] <= at <= allowed[1]:
                low, high = (f"{bound:g}" for bound in allowed)
                message = error_text(
                    "leaves-workspace",
                    command=command.name,
                    target=tuple(angles),
                    axis=axis,
                    at=f"{at:.1f}",
                    low=low,
                    high=high,
                )
                raise UsageError(axis, at, f"{low}..{high}", message=message)
