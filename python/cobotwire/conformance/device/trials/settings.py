"""What is set is read back, leaves its neighbours, and is set back afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from cobotwire.conformance.device.catalogue import (
    ACKNOWLEDGED,
    NEIGHBOURS,
    READ_BACK,
    REPLIED,
    RESTORED,
    SILENT,
    Rule,
)
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.readable import Readable, Values, readable
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.orders import order
from cobotwire.errors import UsageError
from cobotwire.table import Command, Table


def is_setting(table: Table, command: Command) -> bool:
    """Whether a command sets what a query tells, and its own arguments set it back."""
    return command.safety not in ("query", "motion") and bool(readable(table, command))


@dataclass(frozen=True, slots=True)
class _Spot:
    """One joint, pin or register, and what was there before."""

    setting: Readable
    key: Values
    old: Values
    # Whether the command can set again what was there.
    restorable: bool = True

    def __str__(self) -> str:
        said = ", ".join(f"{name}={value}" for name, value in self.key.items())
        return f"{self.setting.command.name}({said})"


@trial(READ_BACK, NEIGHBOURS, RESTORED, SILENT, ACKNOWLEDGED, REPLIED, of=is_setting)
def set_and_read(case: Case) -> None:
    """Back up, set several values for each joint, pin or register, read all, set back."""
    for setting in readable(case.bench.table, case.command):
        spots = [_spot(case, setting, key) for key in setting.keys]
        if len(spots) == 1:
            case.without(NEIGHBOURS)
        for spot in spots:
            if spot.restorable:
                case.bench.undo[str(spot)] = partial(_restore, case, spot)
        for spot in spots:
            _try(case, spot, spots)
            case.bench.undo.pop(str(spot), None)


def _spot(case: Case, setting: Readable, key: Values) -> _Spot:
    """Back up.

    Raises:
        Unsupported: it cannot be read, or what is there cannot be set again.
    """
    old = _read(case, setting, key)
    if old is None:
        raise Unsupported(f"{setting.query.name} tells nothing, so nothing can be read back")
    values, text = setting.request(key, old)
    try:
        case.bench.asker.request(setting.command, values, text)
    except UsageError as error:
        if "irreversible" not in case.bench.leave.classes:
            raise Unsupported(f"what is there could not be set again: {error}") from None
        return _Spot(setting, key, old, restorable=False)
    return _Spot(setting, key, old)


def _read(case: Case, setting: Readable, key: Values) -> Values | None:
    fields = case.bench.read(setting.query, setting.question(key))
    return None if fields is None else setting.told(fields)


def _set(case: Case, spot: _Spot, wanted: Values) -> bool:
    """Set; whether the reply, where one is due, says that it has failed."""
    values, text = spot.setting.request(spot.key, wanted)
    good = order(case, spot.setting.command, values, text).good
    flags = [] if good is None or good.message is None else good.message.layout.fields
    return any(f.kind == "flag" and not f.echo and not good.fields[f.name] for f in flags if good)


def _restore(case: Case, spot: _Spot) -> None:
    _set(case, spot, spot.old)


def _try(case: Case, spot: _Spot, spots: list[_Spot]) -> None:
    for index, wanted in enumerate(spot.setting.tries(spot.key, spot.old)):
        failed = _set(case, spot, wanted)
        _expect(case, READ_BACK, spot, wanted)
        case.expect(REPLIED, not failed, f"{spot} says that it failed, but {wanted} is read back")
        for other in spots if index == 0 else ():
            if other is not spot:
                _expect(case, NEIGHBOURS, other, other.old, f"behind {spot}: ")
    if spot.restorable:
        _set(case, spot, spot.old)
        _expect(case, RESTORED, spot, spot.old)


def _expect(case: Case, rule: Rule, spot: _Spot, wanted: Values, when: str = "") -> None:
    wrong = spot.setting.differences(wanted, _read(case, spot.setting, spot.key))
    case.expect(rule, not wrong, f"{when}{spot}, {'; '.join(wrong)}")
