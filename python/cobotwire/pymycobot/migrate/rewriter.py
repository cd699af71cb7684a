"""Rewrites the calls of a program, and notes what a person must decide."""

from __future__ import annotations

import libcst as cst
from libcst.helpers import get_full_name_for_node
from libcst.metadata import PositionProvider

from cobotwire.pymycobot.migrate import imports
from cobotwire.pymycobot.migrate.arguments import (
    code,
    given,
    ours,
    serial_arguments,
    socket_arguments,
)
from cobotwire.pymycobot.migrate.calls import Call, LibraryClass, library
from cobotwire.pymycobot.migrate.decisions import (
    HOME,
    NEVER_FAILED,
    NO_COUNTERPART,
    OTHER_ROBOT,
    RESULTS,
    SEVERAL,
    TIMEOUT,
    UNKNOWN,
    Decision,
)
from cobotwire.pymycobot.migrate.names import LIBRARY, Names

# Methods that nothing but an arm has.
_TELLING = {"send_angle", "send_angles", "send_coord", "send_coords", "sync_send_angles"}
_TELLING |= {"get_angles", "get_coords", "sync_send_coords", "release_all_servos"}


class Rewriter(cst.CSTTransformer):
    """Rewrites one program; notes what to decide, and whether it calls ``time.sleep`` now."""

    METADATA_DEPENDENCIES = (PositionProvider,)

    def __init__(self, names: Names) -> None:
        super().__init__()
        self.names = names
        self.decisions: list[Decision] = []
        self.sleeps = False
        # The calls whose result is not used.
        self._statements: set[cst.CSTNode] = set()

    def visit_Expr(self, node: cst.Expr) -> None:
        self._statements.add(node.value)

    def decide(self, node: cst.CSTNode, what: str) -> None:
        """Note what a person must decide at a node of the program."""
        start = self.get_metadata(PositionProvider, node).start
        self.decisions.append(Decision(start.line, start.column + 1, what))

    def visit_Import(self, node: cst.Import) -> None:
        for alias in node.names:
            if alias.evaluated_name.partition(".")[0] == LIBRARY:
                what = f"write `from {LIBRARY} import ...`, and run this again"
                self.decide(
                    node, f"names of `import {alias.evaluated_name}` are not rewritten; {what}"
                )

    def leave_SimpleStatementLine(
        self, original_node: cst.SimpleStatementLine, updated_node: cst.SimpleStatementLine
    ) -> cst.SimpleStatementLine | cst.FlattenSentinel[cst.SimpleStatementLine]:
        # The names of the line as it was; those of classes are others by now.
        [first, *others] = original_node.body
        if others or not isinstance(first, cst.ImportFrom) or not imports.is_of_library(first):
            return updated_node
        # The names as they were: others were renamed before their line.
        [before] = original_node.body
        lines, left = imports.rewritten(cst.ensure_type(before, cst.ImportFrom))
        for name in left:
            self.decide(original_node, f"cobotwire has no counterpart of {name}")
        made = [updated_node.with_changes(body=[line]) for line in lines]
        return cst.FlattenSentinel([made[0], *(m.with_changes(leading_lines=[]) for m in made[1:])])

    def leave_Name(self, original_node: cst.Name, updated_node: cst.Name) -> cst.Name:
        # A class that is renamed: MyCobot280Socket is MyCobot280 on another port.
        found = self.names.classes.get(updated_node.value)
        if found != updated_node.value:
            return updated_node
        return updated_node.with_changes(value=library()[found].native)

    def leave_Comparison(
        self, original_node: cst.Comparison, updated_node: cst.Comparison
    ) -> cst.Comparison:
        sides = [original_node.left, *(each.comparator for each in original_node.comparisons)]
        if any(map(_is_failure, sides)) and any(map(self._is_result, sides)):
            self.decide(original_node, NEVER_FAILED)
        return updated_node

    def _is_result(self, node: cst.BaseExpression) -> bool:
        if isinstance(node, cst.Call):
            name = get_full_name_for_node(node.func) or ""
            return name.rpartition(".")[0] in self.names.arms
        return get_full_name_for_node(node) in self.names.results

    def leave_Assign(self, original_node: cst.Assign, updated_node: cst.Assign) -> cst.Assign:
        # A tuple stays what it is, but the program changes the list.
        names = {get_full_name_for_node(target.target) for target in original_node.targets}
        call = self._called(original_node.value)
        if call is None or not call.row or not names & self.names.lists:
            return updated_node
        as_list = cst.Call(cst.Name("list"), [cst.Arg(updated_node.value)])
        return updated_node.with_changes(value=as_list)

    def _called(self, node: cst.CSTNode) -> Call | None:
        """Return the method of the library that a node calls."""
        name = get_full_name_for_node(node.func) if isinstance(node, cst.Call) else None
        arm, _, method = (name or "").rpartition(".")
        kind = self.names.arms.get(arm)
        return kind.methods.get(method) if kind else None

    def leave_Call(self, original_node: cst.Call, updated_node: cst.Call) -> cst.BaseExpression:
        name = get_full_name_for_node(original_node.func) or ""
        if name in self.names.several:
            self.decide(original_node, SEVERAL.format(name))
            return updated_node
        if name in self.names.classes:
            return self._constructed(original_node, updated_node, self.names.classes[name])
        arm, _, method = name.rpartition(".")
        kind = self.names.arms.get(arm)
        if kind is None:
            if _looks_like_arm(arm, method):
                self.decide(original_node, UNKNOWN.format(name=arm))
            return updated_node
        if method in _WRITTEN:
            return _WRITTEN[method](self, original_node, updated_node, kind)
        call = kind.methods.get(method)
        if call is None:
            self.decide(original_node, _why_left(kind, method))
            return updated_node
        return self._method(original_node, updated_node, call, kind)

    def _method(
        self, original: cst.Call, updated: cst.Call, call: Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        arguments = ours(call, updated.args)
        if arguments is None:
            self.decide(original, "the arguments are not known here; compare them by hand")
            return updated
        if call.result in RESULTS:
            self.decide(original, RESULTS[call.result])
        made = _renamed(updated, call.calls).with_changes(args=arguments)
        known = given(updated.args, list(call.parameters)) or {}
        if call.address not in known:
            return made
        return _of_device(made, kind, known[call.address])

    def _constructed(self, original: cst.Call, updated: cst.Call, name: str) -> cst.BaseExpression:
        kind = library()[name]
        known = given(updated.args, kind.constructor)
        if known is None:
            self.decide(original, "the arguments are not known here; compare them by hand")
            return updated
        if kind.on_ports:
            there, *ports = kind.on_ports
            self.decide(original, OTHER_ROBOT.format(kind.native, there, " or ".join(ports)))
        if "timeout" in known:
            self.decide(original, TIMEOUT)
        place, speed = (known.get(each) for each in kind.constructor[:2])
        if place is None:
            self.decide(original, f"{kind.native} needs the port")
            return updated
        opened = socket_arguments if kind.opens == "socket" else serial_arguments
        # The name was changed where the library gave it; one that the program gives stays.
        return updated.with_changes(args=opened(place, speed))

    def sleep(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return ``time.sleep`` instead of ``wait``."""
        if len(updated.args) != 1 or original not in self._statements:
            self.decide(original, "write time.sleep(seconds) in a line of its own")
            return updated
        self.sleeps = True
        seconds = updated.args[0].with_changes(keyword=None, equal=cst.MaybeSentinel.DEFAULT)
        return cst.Call(cst.parse_expression("time.sleep"), [seconds])

    def home(self, original: cst.Call, updated: cst.Call, kind: LibraryClass) -> cst.BaseExpression:
        """Return the call that does what ``go_home`` does."""
        if not kind.home:
            self.decide(original, HOME)
            return updated
        return _in_place_of(updated, kind.home)

    def gripper_kind(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return the query that ``is_torque_gripper`` sends."""
        return _in_place_of(updated, "get_servo_data(7, 1)")

    def stop_gripper(
        self, original: cst.Call, updated: cst.Call, kind: LibraryClass
    ) -> cst.BaseExpression:
        """Return the order that ``gripper_stop`` sends."""
        return _in_place_of(updated, "set_gripper_value(0, 0, 1, 1)")


# The methods that the rewriter writes itself.
_WRITTEN = {
    "wait": Rewriter.sleep,
    "go_home": Rewriter.home,
    "is_torque_gripper": Rewriter.gripper_kind,
    "gripper_stop": Rewriter.stop_gripper,
}


def _is_failure(node: cst.BaseExpression) -> bool:
    return code(node) in ("-1", "None")


def _looks_like_arm(name: str, method: str) -> bool:
    return bool(name) and method in _TELLING


def _in_place_of(called: cst.Call, text: str) -> cst.BaseExpression:
    """Return another call of the same arm."""
    made = cst.parse_expression(f"arm.{text}")
    assert isinstance(made, cst.Call), "it is written here"
    return _renamed(made, cst.ensure_type(made.func, cst.Attribute).attr.value, called)


def _why_left(kind: LibraryClass, method: str) -> str:
    """Return why a call is left as it is."""
    # A class that opens a socket would drive the pins of the robot's computer.
    local = method not in kind.absent or kind.opens == "serial"
    if local and method in NO_COUNTERPART:
        return NO_COUNTERPART[method]
    why = kind.absent.get(method)
    return f"{kind.native} has no counterpart of {method}" + (f": {why}" if why else "")


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
    """Return a call of a method of ours, of the arm that a call has."""
    func = cst.ensure_type((arm_of or made).func, cst.Attribute)
    return made.with_changes(func=func.with_changes(attr=cst.Name(method)))
