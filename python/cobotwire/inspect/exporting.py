"""Find the editions for exports: their codecs, and the kinematics of their arms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cobotwire import editions
from cobotwire.capture.export.plan import Forward
from cobotwire.codec.interface import Codec
from cobotwire.inspect.recorded_edition import codec_of_recording
from cobotwire.kinematics import coords_of, geometry_of


@dataclass(frozen=True, slots=True)
class InstalledEditions:
    """The editions that come with cobotwire, and a default edition: one of them, or a package."""

    default: str = editions.DEFAULT

    def codec(self, name: str) -> Codec:
        """Return the codec of an edition, or of the default edition if ``name`` is empty.

        Raises:
            UsageError: no edition of that name is installed.
        """
        return codec_of_recording(name, self.default)

    def forward(self, name: str) -> Forward | None:
        """Return the kinematics of the edition's arm; None if its geometry is not known."""
        geometry = geometry_of(self.codec(name).table)
        if geometry is None:
            return None

        def forward(angles: Sequence[float]) -> tuple[float, ...]:
            return coords_of(geometry, angles)

        return forward

    def has_command(self, command: str) -> bool:
        """Return whether any edition has a command of that name."""
        tables = (editions.load(name).TABLE for name in editions.names())
        return any(command == each.name for table in tables for each in table.commands)
