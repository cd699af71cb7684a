"""Rewrites the calls of a program, and notes what a person must decide."""

from __future__ import annotations

import libcst as cst

from cobotwire.pymycobot.layer.absent import why_no
from cobotwire.pymycobot.migrate import imports
from cobotwire.pymycobot.migrate.arguments import (
    HIDDEN,
    QUIET,
    code,
    given,
    is_about_motion,
    ours,
    serial_arguments,
    socket_arguments,
)
from cobotwire.pymycobot.migrate.calls import Call, LibraryClass, are_alike, library
from cobotwire.pymycobot.migrate.decisions import (
    EITHER,
    HIDDEN_NAME,
    HOME,
    MIXED,
    OTHER_ROBOT,
    PARAMETER,
    RESULTS,
    SEVERAL,
    TIMEOUT,
    UNKNOWN,
    Decide,
    why_left,
    why_other,
)
from cobotwire.pymycobot.migrate.names import is_of_library
from cobotwire.pymycobot.migrate.uses import Uses
from cobotwire.pymycobot.migrate.values import Arm, Kind

# How a result of ours becomes the library's, and the functions of Python that this needs.
_FORMS = {"int": ("int",), "list": ("list",), "ints": ("list", "map", "int")}


class Rewriter(cst.CSTTransformer):
    """Rewrites one program; notes what to decide, and whether it calls ``time.sleep`` now."""

    def __init__(self, uses: Uses, decide: Decide) -> None:
        super().__init__()
        self.decide = decide
        self.uses = uses
        self.names = uses.names
        self.sleeps = False

    def leave_SimpleStatementLine(
        self, original_node: cst.SimpleStatementLine, updated_node: cst.SimpleStatementLine
    ) -> cst.SimpleStatementLine | cst.FlattenSentinel[cst.SimpleStatementLine]:
        # The names of the original line; the names of classes have been replaced since.
        [first, *others] = original_node.body
        if others or not isinstance(first, cst.ImportFrom) or not is_of_library(first):
            return updated_node
        lines, left = imports.rewritten(first)
        for name in left:
            self.decide(original_node, why_no(name) or f"cobotwire has no counterpart of {name}")
        made = [updated_node.with_changes(body=[line]) for line in lines]
        return cst.FlattenSentinel([made[0], *(m.with_changes(leading_lines=[]) for m in made[1:])])

    def leave_Name(self, original_node: cst.Name, updated_node: cst.Name) -> cst.Name:
        # A class that is renamed: MyCobot280Socket is MyCobot280 on another port.
        inside = self.names.keys.parents[original_node]
        names_part = isinstance(inside, cst.Attribute) and inside.attr is original_node
        names_argument = isinstance(inside, cst.Arg) and inside.keyword is original_node
        if names_part or names_argument:
            return updated_node
        if Kind(original_node.value) not in self.names.values(original_node):
            return updated_node
        return updated_node.with_changes(value=library()[original_node.value].native)

    def leave_Call(self, original_node: cst.Call, updated_node: cst.Call) -> cst.BaseExpression:
        kinds = self.names.kinds(original_node.func)
        if kinds and self.names.is_ours(original_node.func):
            return updated_node
        if kinds:
            if len(kinds) == 1 and self.names.is_only(original_node.func, Kind):
                return self._constructed(original_node, updated_node, kinds[0])
            self.decide(original_node, SEVERAL.format(code(original_node.func)))
        if kinds or not isinstance(original_node.func, cst.Attribute):
            return updated_node
        arm, method = original_node.func.value, original_node.func.attr.value
        arms = [library()[each] for each in self.names.arms(arm)]
        if not arms:
            if self.uses.may_be_arm(arm, method):
                self._note_unknown(original_node, arm)
            return updated_node
        if not self.names.is_only(arm, Arm) or not are_alike(arms, method):
            self.decide(original_node, MIXED.format(code(arm)))
            return updated_node
        return self._of_arm(original_node, updated_node, arms[0], method)

    def _note_unknown(self, call: cst.Call, arm: cst.BaseExpression) -> None:
        """List an arm of unknown class as undecided; a parameter once for all its calls."""
        for found in self.names.keys.assigned(arm) if isinstance(arm, cst.Name) else ():
            function = self.names.keys.function_of(found)
            if isinstance(found, cst.Param) and function and not found.annotation:
                kind = " or ".join(self.names.classes()) or "MyCobot280"
                name = function.name.value
                self.decide(
                    found, PARAMETER.format(name=found.name.value, function=name, kind=kind)
                )
                return
        self.decide(call, UNKNOWN.format(name=code(arm)))

    def _of_arm(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass, method: str
    ) -> cst.BaseExpression:
        is_ours = self.names.is_ours(cst.ensure_type(original.func, cst.Attribute).value)
        if is_ours and (found := self._rewritten_before(original, kind, method)):
            return self._with_result(original, updated, found)
        if is_ours and method == "go_home":
            self.decide(original, HOME)
            return updated
        if method in _WRITTEN and kind.has(method):
            return _WRITTEN[method](self, original, updated, kind)
        call = kind.call(method)
        if call is None:
            self.decide(original, why_left(kind, method))
            return updated
        return self._method(original, updated, call, kind)

    def _rewritten_before(self, call: cst.Call, kind: LibraryClass, method: str) -> Call | None:
        """Return how the library calls a method of ours; None if the call may be the library's."""
        theirs = kind.call(method)
        if theirs and given(call.args, list(theirs.parameters)) is not None:
            return None
        if not hasattr(kind.client, method) or (theirs is None and kind.has(method)):
            return None
        return kind.called(method) or Call(method, {}, {}, gives="same")

    def _method(
        self, original: cst.Call, updated: cst.Call, call: Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        arguments = ours(call, updated.args)
        if isinstance(arguments, str):
            self.decide(original, arguments)
            return updated
        if self.names.is_ours(cst.ensure_type(original.func, cst.Attribute).value):
            again = ours(call, arguments) if call is kind.call(call.calls) else arguments
            if not isinstance(again, str) and _shown(again) != _shown(arguments):
                self.decide(original, EITHER)
                return updated
        known = given(updated.args, list(call.parameters)) or {}
        if is_about_motion(call, known, kind):
            self.decide(original, RESULTS[call.result])
        made = _renamed(updated, call.calls).with_changes(args=arguments)
        if call.address in known:
            made = _of_device(made, kind, known[call.address])
        return self._with_result(original, made, call)

    def _with_result(self, original: cst.Call, made: cst.Call, call: Call) -> cst.BaseExpression:
        """Return a call, converted to the library's result where the program needs that."""
        uses = self.uses.of(original)
        if call.gives == "same" or not uses:
            return made
        if call.gives not in _FORMS:
            self.decide(original, why_other(call))
            return made
        if call.gives != "ints" and all(self.uses.is_proven(use, call.gives) for use in uses):
            return made
        if all(self.uses.is_converted(use, call.gives) for use in uses):
            return made
        for name in filter(self.uses.is_hidden, _FORMS[call.gives]):
            self.decide(original, HIDDEN_NAME.format(name))
            return made
        made = _called("map", cst.Name("int"), made) if call.gives == "ints" else made
        return _called(_FORMS[call.gives][0], made)

    def _constructed(self, original: cst.Call, updated: cst.Call, name: str) -> cst.BaseExpression:
        kind = library()[name]
        known = given(updated.args, kind.constructor)
        if known is None:
            self.decide(original, HIDDEN)
            return updated
        place, speed = (_or_default(known, kind, each) for each in kind.constructor[:2])
        is_known = isinstance(place, cst.SimpleString) and place.evaluated_value
        if kind.on_ports and (not is_known or is_known in kind.on_ports):
            there, *ports = kind.on_ports
            self.decide(original, OTHER_ROBOT.format(kind.native, there, " or ".join(ports)))
        if "timeout" in known:
            self.decide(original, TIMEOUT)
        if place is None:
            self.decide(original, f"{kind.native} needs the port")
            return updated
        opened = socket_arguments if kind.opens == "socket" else serial_arguments
        # The class's name was replaced if it came from the library; other names stay.
        return updated.with_changes(args=opened(place, speed))

    def sleep(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return ``time.sleep`` instead of ``wait``."""
        if len(updated.args) != 1 or updated.args[0].star or self.uses.of(original):
            self.decide(original, "write time.sleep(seconds) in a line of its own")
            return updated
        if self.uses.is_hidden("time"):
            self.decide(original, HIDDEN_NAME.format("time"))
            return updated
        self.sleeps = True
        seconds = updated.args[0].with_changes(keyword=None, equal=cst.MaybeSentinel.DEFAULT)
        return _called("time.sleep", seconds.value)

    def home(self, original: cst.Call, updated: cst.Call, kind: LibraryClass) -> cst.BaseExpression:
        """Return the call that does what ``go_home`` does."""
        if not kind.home:
            self.decide(original, HOME)
            return updated
        return self._instead(original, updated, kind.home, "nothing")

    def gripper_kind(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return the query that ``is_torque_gripper`` sends."""
        return self._instead(original, updated, "get_servo_data(7, 1)", "same")

    def stop_gripper(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return the request that ``gripper_stop`` sends."""
        return self._instead(original, updated, "set_gripper_value(0, 0, 1, 1)", "nothing")

    def _instead(
        self, original: cst.Call, updated: cst.Call, text: str, gives: str
    ) -> cst.BaseExpression:
        """Return another call of the same arm."""
        if any(each.keyword is None or each.keyword.value != QUIET for each in updated.args):
            self.decide(original, HIDDEN)
            return updated
        made = cst.ensure_type(cst.parse_expression(f"arm.{text}"), cst.Call)
        name = cst.ensure_type(made.func, cst.Attribute).attr.value
        return self._with_result(
            original, _renamed(made, name, updated), Call(name, {}, {}, gives=gives)
        )


# The methods that the rewriter writes itself.
_WRITTEN = {
    "wait": Rewriter.sleep,
    "go_home": Rewriter.home,
    "is_torque_gripper": Rewriter.gripper_kind,
    "gripper_stop": Rewriter.stop_gripper,
}


def _or_default(
    known: dict[str, cst.BaseExpression], kind: LibraryClass, parameter: str
) -> cst.BaseExpression | None:
    """Return an argument of a constructor, or the library's default if ours may be another."""
    default = kind.default(parameter)
    if parameter in known or str(default) in ("None", str(kind.usual)):
        return known.get(parameter)
    return cst.parse_expression(f'"{default}"' if isinstance(default, str) else f"{default}")


def _shown(arguments: list[cst.Arg]) -> str:
    return code(cst.Call(cst.Name("_"), arguments))


def _called(name: str, *arguments: cst.BaseExpression) -> cst.Call:
    return cst.Call(cst.parse_expression(name), [cst.Arg(each) for each in arguments])


def _of_device(made: cst.Call, kind: LibraryClass, address: cst.BaseExpression) -> cst.Call:
    """Return a call of the device that an address selects: ``arm.left``, or ``arm.at(number)``."""
    func = cst.ensure_type(made.func, cst.Attribute)
    name = kind.devices.get(code(address))
    device = (
        cst.Attribute(func.value, cst.Name(name))
        if name
        else cst.Call(cst.Attribute(func.value, cst.Name("at")), [cst.Arg(address)])
    )
    return made.with_changes(func=func.with_changes(value=device))


def _renamed(made: cst.Call, method: str, arm_of: cst.Call | None = None) -> cst.Call:
    """Return a call with the name of our method; ``arm_of`` has the arm, by default the call."""
    func = cst.ensure_type((arm_of or made).func, cst.Attribute)
    return made.with_changes(func=func.with_changes(attr=cst.Name(method)))
