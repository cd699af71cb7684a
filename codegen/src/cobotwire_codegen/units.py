"""The units of quantities: names, symbols and plurals, all derived from one short table."""

from __future__ import annotations

from typing import NamedTuple


class Unit(NamedTuple):
    """The symbol of a unit, and its plural in texts."""

    symbol: str
    plural: str


_PREFIXES = {"kilo": "k", "centi": "c", "milli": "m", "micro": "µ", "nano": "n"}

# Name: symbol, plural, and the prefixes with which people use the unit.
_BASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "ampere": ("A", "amperes", ("milli", "micro")),
    "ampere_hour": ("Ah", "ampere hours", ("milli",)),
    "bar": ("bar", "bars", ("milli",)),
    "baud": ("Bd", "bauds", ()),
    "bit": ("bit", "bits", ()),
    "byte": ("B", "bytes", ()),
    "decibel": ("dB", "decibels", ()),
    "degree": ("°", "degrees", ("milli",)),
    "degree_celsius": ("°C", "degrees Celsius", ()),
    "degree_per_second": ("°/s", "degrees per second", ()),
    "farad": ("F", "farads", ("micro",)),
    "gram": ("g", "grams", ("kilo", "milli")),
    "hertz": ("Hz", "hertz", ("kilo", "milli")),
    "hour": ("h", "hours", ()),
    "joule": ("J", "joules", ("kilo", "milli")),
    "kelvin": ("K", "kelvins", ("milli",)),
    "litre": ("l", "litres", ("milli",)),
    "lux": ("lx", "lux", ()),
    "metre": ("m", "metres", ("kilo", "centi", "milli", "micro")),
    "metre_per_second": ("m/s", "metres per second", ("milli",)),
    "metre_per_second_squared": ("m/s²", "metres per second squared", ("milli",)),
    "minute": ("min", "minutes", ()),
    "newton": ("N", "newtons", ("kilo", "milli")),
    "newton_metre": ("N·m", "newton metres", ("centi", "milli")),
    "ohm": ("Ω", "ohms", ("kilo", "milli")),
    "pascal": ("Pa", "pascals", ("kilo", "milli")),
    "percent": ("%", "percent", ()),
    "radian": ("rad", "radians", ("milli",)),
    "radian_per_second": ("rad/s", "radians per second", ("milli",)),
    "radian_per_second_squared": ("rad/s²", "radians per second squared", ()),
    "revolution": ("r", "revolutions", ()),
    "revolution_per_minute": ("rpm", "revolutions per minute", ()),
    "second": ("s", "seconds", ("milli", "micro", "nano")),
    "step": ("step", "steps", ()),
    "step_per_second": ("step/s", "steps per second", ()),
    "step_per_second_squared": ("step/s²", "steps per second squared", ()),
    "tesla": ("T", "teslas", ("milli", "micro")),
    "tick": ("tick", "ticks", ()),
    "volt": ("V", "volts", ("kilo", "milli", "micro")),
    "watt": ("W", "watts", ("kilo", "milli", "micro")),
    "watt_hour": ("Wh", "watt hours", ("kilo",)),
}


def _all_units() -> dict[str, Unit]:
    found: dict[str, Unit] = {}
    for name, (symbol, plural, prefixes) in _BASES.items():
        found[name] = Unit(symbol, plural)
        for prefix in prefixes:
            found[prefix + name] = Unit(_PREFIXES[prefix] + symbol, prefix + plural)
    return dict(sorted(found.items()))


UNITS = _all_units()
