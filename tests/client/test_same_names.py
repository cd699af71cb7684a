"""The two clients of an edition have the same method names, arguments and types."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

from cobotwire import editions

NAMES = editions.names()


def methods(client: type) -> dict[str, Any]:
    return {
        name: value
        for name, value in inspect.getmembers(client, inspect.isfunction)
        if not name.startswith("_")
    }


def shape(method: Any) -> inspect.Signature:
    """Return a signature without the asynchronous sources and the `Async` of a result."""
    found = inspect.signature(method)
    parameters = [
        each.replace(annotation=str(each.annotation).removesuffix(" | AsyncTargets"))
        for each in found.parameters.values()
    ]
    result = str(found.return_annotation).removeprefix("Async")
    return found.replace(parameters=parameters, return_annotation=result)


def _called(package: Any) -> list[Any]:
    """Return the commands that have a method; an event has none."""
    return [command for command in package.TABLE.commands if not command.event]


@pytest.mark.parametrize("edition", NAMES)
def test_both_clients_have_the_same_methods(edition: str) -> None:
    package: Any = editions.load(edition)
    blocking, asynchronous = methods(package.CLIENT), methods(package.ASYNC_CLIENT)
    assert set(asynchronous) - set(blocking) == {"open"}
    assert set(blocking) <= set(asynchronous)
    for name in blocking:
        assert shape(blocking[name]) == shape(asynchronous[name]), name
    for command in _called(package):
        assert asynchronous[command.name].__doc__ == blocking[command.name].__doc__
        assert inspect.iscoroutinefunction(asynchronous[command.name])
        assert not inspect.iscoroutinefunction(blocking[command.name])


@pytest.mark.parametrize("edition", NAMES)
def test_edition_has_no_methods_or_messages_of_commands_that_only_others_have(edition: str) -> None:
    package: Any = editions.load(edition)
    every = {command.name: command for name in NAMES for command in _called(editions.load(name))}
    for name in every.keys() - {command.name for command in _called(package)}:
        assert not hasattr(package.CLIENT, name)
        assert not hasattr(package.ASYNC_CLIENT, name)
        assert not hasattr(package, every[name].request_type.__name__)


@pytest.mark.parametrize("edition", NAMES)
def test_method_has_ack_within_if_the_edition_has_an_acknowledgement(edition: str) -> None:
    package: Any = editions.load(edition)
    for command in _called(package):
        parameters = inspect.signature(getattr(package.CLIENT, command.name)).parameters
        assert ("ack_within" in parameters) == command.ack, command.name


def test_name_that_an_edition_lacks_is_an_attribute_error() -> None:
    package: Any = editions.load("mycobot")
    with pytest.raises(AttributeError, match="no attribute 'Nothing'"):
        package.Nothing  # noqa: B018  (the lookup raises)
