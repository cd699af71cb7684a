"""Writes the arguments of a call of the library for our method."""

from __future__ import annotations

from collections.abc import Sequence

import libcst as cst
from libcst import matchers

from cobotwire.pymycobot.migrate.calls import Call, LibraryClass

QUIET = "_async"
HIDDEN = "the arguments are not known here; compare them by hand"
DROPPED = "our {} has no argument for {}; remove it, or do what it does by another call"
IN_TURN = "the calls inside would run in another order; assign their results to names first"


def given(
    arguments: Sequence[cst.Arg], parameters: Sequence[str]
) -> dict[str, cst.BaseExpression] | None:
    """Return the arguments by the library's parameters; None if they are not known.

    They are not known if ``*`` or ``**`` hides them, or if the library's method does not take them.
    """
    found: dict[str, cst.BaseExpression] = {}
    for index, argument in enumerate(arguments):
        if argument.star or (argument.keyword is None and index >= len(parameters)):
            return None
        name = argument.keyword.value if argument.keyword else parameters[index]
        if name not in parameters or name in found:
            return None
        found[name] = argument.value
    return found


def ours(call: Call, arguments: Sequence[cst.Arg]) -> list[cst.Arg] | str:
    """Return the arguments of our method, or why they cannot be known.

    An argument without a keyword keeps its position, as far as our method allows it.
    """
    known = given(arguments, list(call.parameters))
    if known is None:
        return HIDDEN
    passed = {parameter for parameter, _ in call.arguments.values()} | {call.address, QUIET}
    for name in known.keys() - passed:
        if code(known[name]) not in ("None", call.parameters[name]):
            return DROPPED.format(call.calls, name)
    count = sum(1 for each in arguments if each.keyword is None)
    positional = set(list(call.parameters)[:count])
    made: list[cst.Arg] = []
    in_place = True
    for name, (parameter, default) in call.arguments.items():
        value = _passed(call, parameter, default, known.get(parameter))
        if value is None:
            in_place = False
            continue
        by_name = parameter in known and parameter not in positional
        in_place = in_place and not by_name and name not in call.keywords
        made.append(cst.Arg(value) if in_place else _named(name, value))
    return _laid_out(made) if _run_in_turn(known, made) else IN_TURN


def _passed(
    call: Call, parameter: str, default: str, value: cst.BaseExpression | None
) -> cst.BaseExpression | None:
    """Return the argument of our method for a parameter; None: the argument is left out.

    ``parameter`` may also be a constant, which is always written. Where the library's default is 0
    or False and ours is None, 0 and False count as left out.
    """
    if parameter not in call.parameters:
        return cst.parse_expression(parameter)
    theirs = call.parameters[parameter]
    if theirs in ("0", "False") and default == "None":
        text = "None" if value is None else code(value)
        if text.endswith(" or None"):
            return value
        if text in ("0", "False", "None"):
            return None
        is_set = isinstance(value, cst.Integer | cst.Float) or text == "True"
        plain = isinstance(value, cst.Name | cst.Attribute | cst.Call | cst.Subscript)
        made = cst.parse_expression(f"{text} or None" if plain else f"({text}) or None")
        return value if is_set else made
    if value is not None:
        return value
    return cst.parse_expression(theirs) if theirs and theirs != default else None


def _run_in_turn(known: dict[str, cst.BaseExpression], made: Sequence[cst.Arg]) -> bool:
    """Return whether the calls in arguments run in the order of the program."""
    before = [value for value in known.values() if matchers.findall(value, matchers.Call())]
    after = [each.value for each in made if each.value in before]
    return len(before) < 2 or before == after


def _named(name: str, value: cst.BaseExpression) -> cst.Arg:
    without_space = cst.AssignEqual(cst.SimpleWhitespace(""), cst.SimpleWhitespace(""))
    return cst.Arg(value, cst.Name(name), equal=without_space)


def _laid_out(arguments: list[cst.Arg]) -> list[cst.Arg]:
    comma = cst.Comma(whitespace_after=cst.SimpleWhitespace(" "))
    return [
        each.with_changes(comma=comma if index < len(arguments) - 1 else cst.MaybeSentinel.DEFAULT)
        for index, each in enumerate(arguments)
    ]


def serial_arguments(
    port: cst.BaseExpression, baudrate: cst.BaseExpression | None
) -> list[cst.Arg]:
    """Return the arguments that open a serial port: our client takes the speed as a number."""
    if baudrate is None:
        return [cst.Arg(port)]
    if isinstance(baudrate, cst.SimpleString) and str(baudrate.evaluated_value).isdecimal():
        number: cst.BaseExpression = cst.Integer(str(int(str(baudrate.evaluated_value))))
    elif isinstance(baudrate, cst.Integer) or code(baudrate) == "PI_BAUD":
        number = baudrate
    else:
        number = cst.Call(cst.Name("int"), [cst.Arg(baudrate)])
    return _laid_out([cst.Arg(port), cst.Arg(number)])


def socket_arguments(host: cst.BaseExpression, port: cst.BaseExpression | None) -> list[cst.Arg]:
    """Return the arguments that connect to a TCP server: our client takes a URL."""
    number = cst.Integer("9000") if port is None else port
    parts = [_in_f_string(part) for part in (host, number)]
    url = f"socket://{parts[0]}:{parts[1]}"
    quote = "'" if '"' in url else '"'
    if "'" in url and '"' in url:
        made = f'"socket://{{}}:{{}}".format({code(host)}, {code(number)})'
    else:
        made = f"{'f' if '{' in url else ''}{quote}{url}{quote}"
    return [cst.Arg(cst.parse_expression(made))]


def _in_f_string(node: cst.BaseExpression) -> str:
    """Return a value as a part of an f-string: itself if it is a literal."""
    if isinstance(node, cst.SimpleString):
        return str(node.raw_value)
    return node.value if isinstance(node, cst.Integer) else f"{{{code(node)}}}"


def code(node: cst.CSTNode) -> str:
    """Return a node as text."""
    return cst.Module([]).code_for_node(node)


def is_about_motion(call: Call, known: dict[str, cst.BaseExpression], kind: LibraryClass) -> bool:
    """Return whether the library waits for the motion, or a speed may be a row of speeds."""
    if call.result == "one_speed":
        return not isinstance(known.get("speed"), cst.Integer)
    if call.result != "ended":
        return False
    quiet = code(known[QUIET]) if QUIET in known else call.parameters.get(QUIET)
    # The layer sends the Pro 450 a query before a jog.
    return quiet != "True" or kind.native == "Pro450"
