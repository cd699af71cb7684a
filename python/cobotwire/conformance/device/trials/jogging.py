"""Motion by a step, or in a direction until it is stopped: the part moves, and no other does."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.conformance.device.catalogue import (
    ACKNOWLEDGED,
    ARRIVES,
    SILENT,
    STOPS,
)
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import POSES, Mover
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.motion import UNDER_WAY, resume
from cobotwire.conformance.device.trials.orders import order
from cobotwire.table import Command, Field, Number, Table

# A step by unit: far more than a tick, and little enough to stay near.
STEPS = {"degree": 4.0, "millimetre": 8.0}
# How far the others may stray. The end follows joints that stand on ticks.
STRAYS = {"degree": 0.6, "millimetre": 2.5}
# What is slow enough to be stopped near the start, in percent of the fastest.
SLOW = 20


def _shape(command: Command) -> tuple[Field, Field] | None:
    """The part and its way, of an order of a motion by part, way and speed; else None."""
    if command.safety != "motion" or command.role or command.read_by or command.answers:
        return None
    fields = command.request[0].fields
    if len(fields) != 3 or any(field.many for field in fields):
        return None
    part, way, speed = fields
    return (part, way) if speed.cases[0].numbers[0].unit == "percent" else None


def is_step(table: Table, command: Command) -> bool:
    """Whether a command moves one part by a distance."""
    shape = _shape(command)
    return shape is not None and shape[1].cases[0].numbers[0].scaled


def is_jog(table: Table, command: Command) -> bool:
    """Whether a command moves one part in one of two directions."""
    shape = _shape(command)
    return shape is not None and len(shape[1].choices) == 2


@trial(ARRIVES, SILENT, ACKNOWLEDGED, of=is_step)
def step(case: Case) -> None:
    """A step of each part, up and down."""
    nearby(case, _parts(case)[0], absolute=False)


def nearby(case: Case, part: Field, *, absolute: bool) -> None:
    """Send each part a little way up and down.

    An arm may refuse what it cannot reach: a way that it goes from none of the poses is taken for
    one. An arm that goes no way at all is not.
    """
    mover = Mover(case)
    stays = [
        _stays(case, mover, part, chosen, sign, absolute=absolute)
        for chosen in _choices(part)
        for sign in (1, -1)
    ]
    found = f"{case.command.name}: from {len(POSES)} poses the arm went no way at all"
    case.expect(ARRIVES, not all(stays), found)


def _stays(
    case: Case, mover: Mover, part: Field, chosen: int, sign: int, *, absolute: bool
) -> bool:
    """Send a part one way, from pose to pose, until it goes, and see where; True: it never does."""
    for which in range(len(POSES)):
        mover.go(mover.pose(which))
        before, numbers = where(case, part)
        at = place(part, chosen, numbers)
        distance = sign * STEPS[numbers[at].unit]
        target = round(before[at] + distance, 2)
        order(case, case.command, (chosen, target if absolute else distance, mover.speed))
        mover.wait()
        after, _ = where(case, part)
        if _off(numbers, before, after):
            wrong = _off(numbers, [*before[:at], target, *before[at + 1 :]], after)
            call = f"{case.command.name}({part.name}={chosen}), {distance} {numbers[at].unit}"
            case.expect(ARRIVES, not wrong, f"{call} from there: {'; '.join(wrong)}")
            return False
    return True


@trial(ARRIVES, STOPS, SILENT, ACKNOWLEDGED, of=is_jog)
def jog(case: Case) -> None:
    """Each part in both directions, and a stop; as with steps, some ways may be out of reach."""
    mover, (part, way) = Mover(case), _parts(case)
    goes = [
        _jog(case, mover, part, chosen, direction)
        for chosen in _choices(part)
        for direction in way.choices
    ]
    found = f"{case.command.name}: from {len(POSES)} poses the arm went no way at all"
    case.expect(ARRIVES, any(goes), found)


def _jog(case: Case, mover: Mover, part: Field, chosen: int, direction: int) -> bool:
    """Move one part in one direction, from pose to pose, until it goes; whether it ever does."""
    for which in range(len(POSES)):
        mover.go(mover.pose(which))
        before, numbers = where(case, part)
        order(case, case.command, (chosen, direction, min(SLOW, mover.speed)))
        mover.rest(4 * UNDER_WAY)
        after = _stopped(case, mover, part)
        moved = [now - then for now, then in zip(after, before)]
        if any(abs(by) > STRAYS[number.unit] for by, number in zip(moved, numbers)):
            way = case.command.request[0].fields[1]
            wrong = _not_so(part, chosen, way, direction, numbers, moved)
            call = f"{case.command.name}({part.name}={chosen}, {direction})"
            found = f"{call}: expected {wrong}; it moved by {_short(moved)}"
            case.expect(ARRIVES, not wrong, found)
            return True
    return False


def _stopped(case: Case, mover: Mover, part: Field) -> Sequence[float]:
    """Where the arm is behind a stop, and that it stays there."""
    bare = (
        c for c in case.bench.table.commands if c.safety == "motion" and not c.request[0].fields
    )
    ending = next((c for c in bare if c.family == case.command.family), None)
    if ending is None:
        _halt(case)
    else:
        case.bench.ask(ending)
    mover.rest(2 * UNDER_WAY)
    stood, numbers = where(case, part)
    mover.rest(4 * UNDER_WAY)
    later, _ = where(case, part)
    moved = any(abs(a - b) > STRAYS[n.unit] for a, b, n in zip(stood, later, numbers))
    _halt(case)
    resume(case)
    case.expect(STOPS, not moved, f"behind a stop: stood at {stood}, then at {later}")
    return stood


def _halt(case: Case) -> None:
    stop = case.bench.command("stop")
    if stop is not None:
        case.bench.ask(stop)


def _not_so(
    part: Field,
    chosen: int,
    way: Field,
    direction: int,
    numbers: tuple[Number, ...],
    moved: Sequence[float],
) -> str:
    """What should have moved, in words, where it was not so."""
    far = [abs(by) > STRAYS[number.unit] for by, number in zip(moved, numbers)]
    label = part.labels[part.choices.index(chosen)].lower() if part.labels else ""
    if label and label not in [number.name for number in numbers]:
        turns = [number.unit == "degree" for number in numbers]
        right = any(far) and not any(f for f, turn in zip(far, turns) if not turn)
        return "" if right else "the end to turn on its place"
    at = place(part, chosen, numbers)
    if not far[at] or any(far[:at]) or any(far[at + 1 :]):
        return f"only {numbers[at].name} to move"
    # The edition says of a way along an axis that the coordinate grows, of a joint only clockwise.
    forward = "FORWARD" in way.labels and way.choices[way.labels.index("FORWARD")] == direction
    if "FORWARD" in way.labels and (moved[at] > 0) is not forward:
        return f"{numbers[at].name} to {'grow' if forward else 'fall'}"
    return ""


def _short(moved: Sequence[float]) -> str:
    return ", ".join(f"{by:.2f}" for by in moved)


def _off(numbers: tuple[Number, ...], wanted: Sequence[float], came: Sequence[float]) -> list[str]:
    return [
        f"{number.name}: expected {want:.2f}, is {have:.2f} {number.unit}"
        for number, want, have in zip(numbers, wanted, came)
        if abs(want - have) > STRAYS[number.unit]
    ]


def _parts(case: Case) -> tuple[Field, Field]:
    shape = _shape(case.command)
    assert shape is not None
    return shape


def _choices(part: Field) -> Sequence[int]:
    number = part.cases[0].numbers[0]
    return part.choices or range(number.minimum, number.maximum + 1)


def where(case: Case, part: Field) -> tuple[Sequence[float], tuple[Number, ...]]:
    """Where the joints are, or the end, whichever a part is of; and how each number is told."""
    query = case.bench.command("coordinates" if part.choices else "joints")
    fields = None if query is None else case.bench.read(query)
    if query is None or fields is None:
        raise Unsupported("nothing tells where the arm is")
    return next(iter(fields.values())), query.reply[0].fields[0].cases[0].numbers


def place(part: Field, chosen: int, numbers: tuple[Number, ...]) -> int:
    """Which of the numbers a part is: by its label, or counted from one."""
    names = [number.name for number in numbers]
    labels = [label.lower() for label in part.labels]
    label = labels[part.choices.index(chosen)] if labels else ""
    return names.index(label) if label in names else chosen - 1
