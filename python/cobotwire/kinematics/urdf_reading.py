"""Read the geometry of an arm from a URDF, which a stranger may have written.

Only the joints between the base and the flange are read. Limits, shapes and files that it names are
ignored.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from cobotwire.kinematics.axes import Axis, links_of
from cobotwire.kinematics.geometry import Link
from cobotwire.kinematics.pose import Pose
from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.robot import Dimensions
from cobotwire.protocol.table import Table

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

LARGEST_BYTES = 1_000_000
MOST_JOINTS = 100
# In metres and radians: no arm is that long, and nothing overflows.
LARGEST = 1000.0
KINDS = ("revolute", "continuous", "fixed")


def with_urdf(table: Table, path: str | None, tip: str | None = None) -> Table:
    """Return the table with the geometry of a URDF, marked as unverified; None: the same table.

    Raises:
        UsageError: the file cannot be read, :func:`read_urdf` rejects it, or ``path`` is missing
            while ``tip`` is given.
    """
    if path is None:
        if tip is not None:
            raise UsageError("tip", tip, message="--tip needs --geometry")
        return table
    try:
        with open(path, "rb") as file:
            links = read_urdf(file.read(LARGEST_BYTES + 1), table.joints, tip)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError("geometry", message=f"{path}: {reason}") from None
    rows = tuple((link.offset, link.alpha, link.a, link.d, link.turned_by) for link in links)
    return table._replace(robot=table.robot._replace(geometry=Dimensions(rows, path)))


def read_urdf(data: bytes, joints: int, tip: str | None = None) -> tuple[Link, ...]:
    """Return the links of an arm, from the base on; the arm must have ``joints`` joints.

    ``tip`` is the link of the flange; None: the only link without another one after it.

    Raises:
        UsageError: the content is too large, is not a URDF, or has no such chain.
    """
    chain = _chain(_root(data), tip)
    moving = [joint for joint in chain if joint.get("type") != "fixed"]
    own = [joint.get("name", "") for joint in moving if joint.find("mimic") is None]
    axes = [Axis((), 0.0, Pose.of([0.0] * 6))]
    for joint in chain:
        _continue(axes, joint, own)
    if len(own) != joints:
        raise _wrong(f"{len(own)} joints between base and flange move; this arm has {joints}")
    return links_of(axes)


def _root(data: bytes) -> Element:
    try:
        from defusedxml.ElementTree import ParseError, fromstring
    except ModuleNotFoundError:
        raise _wrong("reading a URDF needs defusedxml: pip install 'cobotwire[urdf]'") from None
    if len(data) > LARGEST_BYTES:
        raise _wrong(f"the file is larger than {LARGEST_BYTES:,} bytes")
    try:
        # Entities can make a small file huge, or name other files; a URDF needs none.
        root: Element = fromstring(data, forbid_dtd=True)
    # An unknown encoding is a LookupError.
    except (ParseError, ValueError, LookupError) as error:
        raise _wrong(f"the file is not an allowed XML file: {error}") from None
    if root.tag != "robot":
        raise _wrong(f"the root element is {root.tag}, not robot")
    return root


def _chain(robot: Element, tip: str | None) -> list[Element]:
    """Return the joints from the base to the tip."""
    before: dict[str, Element] = {}
    for joint in robot.findall("joint"):
        if before.setdefault(_link(joint, "child"), joint) is not joint:
            raise _wrong(f"two joints lead to the link {_link(joint, 'child')!r}")
    if tip is None:
        parents = {_link(joint, "parent") for joint in before.values()}
        ends = [link for link in before if link not in parents]
        if len(ends) != 1:
            shown = ", ".join(ends[:10]) or "no link"
            raise _wrong(f"the flange must be named with --tip: the joints lead to {shown}")
        tip = ends[0]
    elif tip not in before:
        raise _wrong(f"no joint leads to the link {tip!r}{did_you_mean(tip, before)}")
    chain: list[Element] = []
    while tip in before:
        if len(chain) == MOST_JOINTS:
            raise _wrong(f"more than {MOST_JOINTS} joints lead to the flange, or they form a ring")
        chain.append(before[tip])
        tip = _link(before[tip], "parent")
    return chain[::-1]


def _link(joint: Element, what: str) -> str:
    found = joint.find(f"{what}[@link]")
    if found is None:
        raise _wrong(f"joint {joint.get('name')!r} names no {what}")
    return found.get("link", "")


def _continue(axes: list[Axis], joint: Element, own: list[str]) -> None:
    """Add the origin of a joint to the last axis, and the joint's own axis if it moves."""
    name, kind, mimic = joint.get("name", ""), joint.get("type"), joint.find("mimic")
    if kind not in KINDS:
        raise _wrong(f"joint {name!r} is {kind}; allowed: {', '.join(KINDS)}")
    place = [1000 * metres for metres in _numbers(joint, "origin", "xyz", "0 0 0")]
    turned = map(math.degrees, _numbers(joint, "origin", "rpy", "0 0 0"))
    following = axes[-1].following.then(Pose.of([*place, *turned]))
    axes[-1] = axes[-1]._replace(following=following)
    if kind == "fixed":
        # Its axis has no meaning: files of the maker have 0 0 0.
        return
    x, y, z = _numbers(joint, "axis", "xyz", "1 0 0")
    beside = math.hypot(x, y)
    if not math.hypot(beside, z) > 1e-9:
        raise _wrong(f"the axis of joint {name!r} has no direction")
    # A frame with its z axis along the axis of the joint.
    along = Pose.of([0, 0, 0, 0, *map(math.degrees, (math.atan2(beside, z), math.atan2(y, x)))])
    axes[-1] = axes[-1]._replace(following=following.then(along))
    leader = name if mimic is None else mimic.get("joint")
    if leader not in own:
        raise _wrong(f"joint {name!r} mimics {leader!r}, which is not a joint before the flange")
    [share], [offset] = (
        _numbers(joint, "mimic", *words) for words in (("multiplier", "1"), ("offset", "0"))
    )
    axes.append(Axis(((own.index(leader), share),), math.degrees(offset), along.inverted()))


def _numbers(joint: Element, tag: str, attribute: str, default: str) -> list[float]:
    """Return the numbers of an attribute of an element, as many as the default has."""
    element = joint.find(tag)
    text = default if element is None else element.get(attribute, default)
    wanted = len(default.split())
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        values = []
    if len(values) != wanted or not all(abs(value) <= LARGEST for value in values):
        numbers = "a number" if wanted == 1 else f"{wanted} numbers"
        raise _wrong(f"{attribute} of joint {joint.get('name')!r} is {text!r}; allowed: {numbers}")
    return values


def _wrong(message: str) -> UsageError:
    return UsageError("geometry", message=message)
