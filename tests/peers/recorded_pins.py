"""Stand in for the pins of a Raspberry Pi."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import pytest


class Pins(ModuleType):
    """Replaces RPi.GPIO, which needs the hardware: it records the calls."""

    OUT, IN, BCM, LOW, HIGH = "out", "in", "bcm", 0, 1

    def __init__(self) -> None:
        super().__init__("RPi.GPIO")
        self.called: list[tuple[str, tuple[Any, ...]]] = []

    def __getattr__(self, name: str) -> Any:
        # Hypothesis reads the __file__ of every module: this one has none.
        if name.startswith("__"):
            raise AttributeError(name)

        def call(*arguments: Any) -> Any:
            self.called.append((name, arguments))
            return self if name == "PWM" else 1

        return call


def installed_pins(monkeypatch: pytest.MonkeyPatch) -> Pins:
    """Put new pins in the place of the package."""
    package, pins = ModuleType("RPi"), Pins()
    package.GPIO = pins  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "RPi", package)
    monkeypatch.setitem(sys.modules, "RPi.GPIO", pins)
    return pins
