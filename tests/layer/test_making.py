"""Classes are made from the generator's data, and look as if they were written by hand.

``make lint`` compares their signatures with ``layer/classes.pyi``.
"""

from __future__ import annotations

import inspect
import pickle
import re
import threading
from importlib import import_module
from typing import Any

import pytest

import cobotwire.pymycobot
from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot import Mercury, MyBuddy, MyCobot280, MyCobot280Socket, error
from cobotwire.pymycobot.layer import making
from cobotwire.pymycobot.layer.data import NAMES
from cobotwire.pymycobot.layer.stated import class_row

# Exceptions of robots that no edition covers.
OTHER_ROBOT = re.compile("MyAgv|MyArmMControl|[uU]ltraArm")


@pytest.mark.parametrize("name", NAMES)
def test_class_is_the_same_by_each_name_and_in_a_pickle(name: str) -> None:
    kind = getattr(cobotwire.pymycobot, name)
    module = import_module(f"cobotwire.pymycobot.{class_row(name)['module']}")
    assert kind is getattr(module, name)
    assert kind.__module__ == module.__name__
    assert pickle.loads(pickle.dumps(kind)) is kind


def test_threads_that_make_a_class_at_the_same_time_get_the_same_class(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(making, "_made", {})
    at_once = threading.Barrier(4)
    made: set[type] = set()

    def make() -> None:
        at_once.wait()
        made.add(making.class_named("MyArmC"))

    threads = [threading.Thread(target=make) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 1


@pytest.mark.parametrize(
    ("arguments", "keywords", "message"),
    [
        ((), {}, "missing 3 required positional arguments: 'id', 'degree', and 'speed'"),
        ((1, 2, 3, False, 5), {}, "takes from 4 to 5 positional arguments but 6 were given"),
        ((1, 2, 3), {"joint": 1}, "got an unexpected keyword argument 'joint'"),
        ((1, 2, 3), {"id": 1}, "got multiple values for argument 'id'"),
    ],
)
def test_wrong_arguments_raise_the_type_errors_of_python(
    arguments: tuple[Any, ...], keywords: dict[str, Any], message: str
) -> None:
    with pytest.raises(TypeError) as raised:
        MyCobot280.send_angle(object.__new__(MyCobot280), *arguments, **keywords)
    assert str(raised.value) == f"MyCobot280.send_angle() {message}"


def test_errors_is_given_to_the_constructor_by_name_only() -> None:
    with pytest.raises(TypeError, match="takes from 2 to 4 positional arguments but 5"):
        MyCobot280Socket("127.0.0.1", 9000, False, "return")  # type: ignore[call-arg]


def test_method_shows_its_parameters_and_what_it_calls() -> None:
    method = MyBuddy.set_tool_pwm_output
    assert str(inspect.signature(method)) == (
        "(self, id: 'int', channel: 'int', frequency: 'int', pin_val: 'int') -> 'Any'"
    )
    assert method.__qualname__ == "MyBuddySocket.set_tool_pwm_output"
    assert "``at(id).set_pwm_output(channel, frequency, duty)``" in str(method.__doc__)
    assert str(inspect.signature(Mercury)) == (
        "(port: 'str' = '/dev/ttyAMA1', baudrate: 'str | int' = '115200', timeout: 'float' = 0.1, "
        "debug: 'bool' = False, save_serial_log: 'bool' = False, *, "
        "errors: 'OnFailure | None' = None) -> 'None'"
    )


# pymycobot reads the locale in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_constants_and_exceptions_are_those_of_the_library() -> None:
    import pymycobot
    from pymycobot import error as theirs
    from pymycobot import genre as numbers

    ours = cobotwire.pymycobot
    for name in ("PI_PORT", "PI_BAUD", "__version__"):
        assert getattr(ours, name) == getattr(pymycobot, name)
    for mine, their in ((ours.Angle, numbers.Angle), (ours.Coord, numbers.Coord)):
        assert [(each.name, each.value) for each in mine] == [
            (each.name, each.value) for each in their
        ]
    exceptions = {n for n in vars(theirs) if n.endswith("Exception") and not OTHER_ROBOT.match(n)}
    assert {n: getattr(error, n, None) for n in exceptions} == dict.fromkeys(exceptions, UsageError)


@pytest.mark.parametrize("place", ["cobotwire.pymycobot", "cobotwire.pymycobot.layer.classes"])
def test_unknown_class_is_an_attribute_error(place: str) -> None:
    with pytest.raises(AttributeError, match="'Unknown'"):
        getattr(import_module(place), "Unknown")  # noqa: B009 - it has no such name
