"""Read written URDFs with independent readers; compare geometries of URDFs with matrix products."""

from __future__ import annotations

import json
import math
import re
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cobotwire import UsageError, editions
from cobotwire.cli.shared.simulator_output import JsonLines, Lines
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.editions.pro630 import TABLE as PRO_630
from cobotwire.editions.pro630 import Pro630
from cobotwire.kinematics import Geometry, Pose, coords_of, flange, geometry_of
from cobotwire.kinematics.urdf_reading import LARGEST_BYTES, read_urdf, with_urdf
from cobotwire.kinematics.urdf_writing import write_urdf
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.robot import Dimensions, Robot
from cobotwire.studio.serving import Options, staged
from cobotwire.studio.viewers import Viewer
from command_line import printed, started
from in_process import cobotwire
from kinematic_samples import MYCOBOT_280

KNOWN = [name for name in editions.names() if geometry_of(editions.load(name).TABLE)]
POSES = 10_000 // len(KNOWN)


def by_matrices(text: str, angles: Any) -> Any:
    """Return the matrix of the last link for each row of angles, in metres and degrees."""
    joints = ElementTree.fromstring(text).findall("joint")
    own = [j.get("name") for j in joints if j.get("type") != "fixed" and j.find("mimic") is None]
    product: Any = np.eye(4)
    for joint in joints:
        origin = _attributes(joint, "origin", xyz="0 0 0", rpy="0 0 0")
        still = np.eye(4)
        still[:3, :3] = Rotation.from_euler("xyz", origin["rpy"]).as_matrix()
        still[:3, 3] = origin["xyz"]
        product = product @ still
        if joint.get("type") == "fixed":
            continue
        found = joint.find("mimic")
        leader = joint if found is None else found
        name = leader.get("name" if found is None else "joint")
        share = _attributes(joint, "mimic", multiplier="1", offset="0")
        turn = np.radians(angles[:, own.index(name)]) * share["multiplier"] + share["offset"]
        axis = _attributes(joint, "axis", xyz="1 0 0")["xyz"]
        turned = np.tile(np.eye(4), (len(angles), 1, 1))
        along = np.outer(turn, axis / np.linalg.norm(axis))
        turned[:, :3, :3] = Rotation.from_rotvec(along).as_matrix()
        product = product @ turned
    return product


def _attributes(joint: Any, tag: str, **defaults: str) -> dict[str, Any]:
    element = joint.find(tag)
    texts = defaults if element is None else {**defaults, **element.attrib}
    return {name: np.array([float(word) for word in texts[name].split()]) for name in defaults}


def by_yourdfpy(text: str, angles: Any) -> Any:
    """Return the matrix of the flange for each row of angles, as ``make urdf`` tests it."""
    yourdfpy = pytest.importorskip("yourdfpy", reason="make urdf installs it")
    model = yourdfpy.URDF.load(BytesIO(text.encode()), load_meshes=False)
    assert model.validate(), model.errors
    found = []
    for row in np.radians(angles):
        model.update_cfg(row)
        found.append(model.get_transform("flange", "base"))
    return found


def check(geometry: Geometry, matrices: Any, angles: Any, near: float) -> None:
    """Compare poses: ``near`` is in millimetres and degrees."""
    for row, matrix in zip(angles, matrices):
        x, y, z = (tuple(matrix[:3, axis]) for axis in range(3))
        pose = Pose(x, y, z, tuple(1000 * matrix[:3, 3]))
        assert max(flange(geometry, row).distance(pose)) <= near


@pytest.mark.parametrize("reader", [by_matrices, by_yourdfpy])
@pytest.mark.parametrize("name", KNOWN)
def test_urdf_of_an_edition_has_its_poses_and_is_read_unchanged(name: str, reader: Any) -> None:
    table = editions.load(name).TABLE
    geometry = geometry_of(table)
    assert geometry is not None
    angles = np.random.default_rng(1).uniform(-180, 180, (POSES, table.joints))
    check(geometry, reader(write_urdf(table), angles), angles, 1e-6)
    assert read_urdf(write_urdf(table).encode(), table.joints) == geometry.links


def test_joints_have_the_limits_and_the_speed_of_the_edition() -> None:
    robot = ElementTree.fromstring(write_urdf(TABLE, "left_"))
    links = [link.get("name") for link in robot.findall("link")]
    assert links == [
        f"left_{link}" for link in ("base", *(f"link{n}" for n in range(1, 7)), "flange")
    ]
    joints = robot.findall("joint")[:-1]
    assert [joint.get("name") for joint in joints] == [f"left_j{n}" for n in range(1, 7)]
    for joint, ends in zip(joints, joint_limits(TABLE)):
        limit = _attributes(joint, "limit", lower="", upper="", velocity="", effort="")
        stated = math.degrees(limit["lower"][0]), math.degrees(limit["upper"][0])
        assert stated == pytest.approx(ends)
        assert math.degrees(limit["velocity"][0]) == pytest.approx(150)
    lengths = [float(shape.get("length", "")) for shape in robot.iter("cylinder")]
    assert lengths == pytest.approx([0.13122, 0.1104, 0.096, 0.06462, 0.07318, 0.0486])
    across = _attributes(list(robot.iter("visual"))[1], "origin", xyz="", rpy="")
    assert across["xyz"] == pytest.approx([0, 0.0552, 0])
    along = Rotation.from_euler("xyz", across["rpy"]).apply([0, 0, 1])
    assert abs(along) == pytest.approx([0, 1, 0])
    unlimited = write_urdf(TABLE._replace(robot=Robot(TABLE.robot.geometry), commands=()))
    assert unlimited.count('"continuous"') == unlimited.count('effort="0" velocity="0"') == 6


ANGLES = np.array([[10.0, -70.0, 130.0], [0.0, 0.0, 0.0], [-175.0, 90.0, 33.0]])
numbers = st.sampled_from(["0", "0.1", "-0.05", "1.5708", "-1.5708", "3.14159", "1e-9", "0.0001"])
numbers |= st.floats(-1, 1).map(str)
triples = st.tuples(numbers, numbers, numbers).map(" ".join)
axes = triples.filter(lambda text: any(abs(float(word)) > 1e-3 for word in text.split()))
kinds = st.permutations(["revolute", "continuous", "revolute", "mimic", "mimic", "fixed"])


@given(kinds=kinds, places=st.lists(st.tuples(triples, triples, axes), min_size=6, max_size=6))
def test_chain_with_any_axes_has_the_poses_of_the_product_of_its_matrices(
    kinds: list[str], places: Any
) -> None:
    joints, own = [], 0
    for at, (kind, (xyz, rpy, axis)) in enumerate(zip(kinds, places)):
        own += kind in ("revolute", "continuous")
        name = f"own{own}" if kind in ("revolute", "continuous") else f"other{at}"
        further = '<mimic joint="own2" multiplier="-1.5" offset="0.3"/>' if kind == "mimic" else ""
        joints.append(
            joint(
                f'{further}<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>',
                *(name, "fixed" if kind == "fixed" else "revolute"),
                *(f"link{at}", f"link{at + 1}"),
            )
        )
    text = f'<robot name="any">{"".join(joints)}</robot>'
    check(Geometry(read_urdf(text.encode(), 3)), by_matrices(text, ANGLES), ANGLES, 1e-6)


def joint(
    inside: str, name: str = "a", kind: str = "revolute", parent: str = "base", child: str = "end"
) -> str:
    """Return a joint of a URDF."""
    links = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{links}{inside}</joint>'


ZERO = '<axis xyz="0 0 0"/>'
ARM = joint("", "a", "revolute", "base", "x") + joint("", "b", "revolute", "x", "y")
BOMB = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 10))
WRONG = {
    "no XML": ("robot", "the file is not an allowed XML file: syntax error"),
    "codec": ("<?xml version='1.0' encoding='hex'?><robot/>", "'hex' is not a text encoding"),
    "other root": ("<a/>", "the root element is a, not robot"),
    "entities": (f'<!DOCTYPE a [<!ENTITY e0 "0">{BOMB}]><robot>&e9;</robot>', "DTDForbidden"),
    "other file": ('<!DOCTYPE a SYSTEM "file:///etc/passwd"><robot/>', "DTDForbidden"),
    "no joints": ("<robot/>", "the flange must be named with --tip: the joints lead to no link"),
    "few joints": (ARM, "2 joints between base and flange move; this arm has 3"),
    "no child": ('<joint name="a"/>', "joint 'a' names no child"),
    "two parents": (ARM + joint("", child="x"), "two joints lead to the link 'x'"),
    "two ends": (ARM + joint("", parent="x", child="z"), "--tip: the joints lead to y, z"),
    "ring": (ARM + joint("", parent="x", child="base"), "or they form a ring"),
    "slides": (
        joint("", kind="prismatic"),
        "'a' is prismatic; allowed: revolute, continuous, fixed",
    ),
    "words": (joint('<origin xyz="0 a 0"/>'), "xyz of joint 'a' is '0 a 0'; allowed: 3 numbers"),
    "two": (joint('<axis xyz="0 1"/>'), "xyz of joint 'a' is '0 1'; allowed: 3 numbers"),
    "endless": (joint('<origin rpy="nan 0 1"/>'), "rpy of joint 'a' is 'nan 0 1'"),
    "far": (joint('<origin xyz="0 1e9 0"/>'), "xyz of joint 'a' is '0 1e9 0'; allowed: 3 numbers"),
    "no axis": (joint(ZERO), "the axis of joint 'a' has no direction"),
    "unknown leader": (
        ARM + joint("", "c", "continuous", "y", "z") + joint('<mimic joint="d"/>', "d", parent="z"),
        "joint 'd' mimics 'd', which is not a joint before the flange",
    ),
    "huge": (" " * LARGEST_BYTES, "the file is larger than 1,000,000 bytes"),
    "deep": ("<a>" * 100_000 + "</a>" * 100_000, "the joints lead to no link"),
}


@pytest.mark.parametrize(("inside", "sentence"), WRONG.values(), ids=WRONG)
def test_file_that_does_not_describe_an_arm_is_refused_with_the_reason(
    inside: str, sentence: str
) -> None:
    whole = inside.startswith(("robot", "<a/>", "<!", "<?"))
    with pytest.raises(UsageError, match=re.escape(sentence)):
        read_urdf((inside if whole else f"<robot>{inside}</robot>").encode(), 3)


@given(st.binary(max_size=300) | st.text(st.characters(codec="utf-8")).map(str.encode))
def test_any_bytes_are_refused_with_a_usage_error(data: bytes) -> None:
    for content in (
        data,
        b"<robot>" + data + b"</robot>",
        b"<?xml version='1.0' encoding='" + data,
    ):
        with pytest.raises(UsageError):
            read_urdf(content, 3)


def test_tip_chooses_the_flange_among_several_ends() -> None:
    text = "".join(joint("", f"j{n}", "revolute", f"l{n}", f"l{n + 1}") for n in range(3))
    finger = joint("", "finger", "prismatic", "l3", "nail")
    text = f"<robot>{text}{finger}{joint(ZERO, 'f', 'fixed', 'l3', 'flange')}</robot>"
    # Without an axis, the joints turn about x.
    geometry = Geometry(read_urdf(text.encode(), 3, "flange"))
    assert coords_of(geometry, (10, 20, 30)) == pytest.approx((0, 0, 0, 60, 0, 0), abs=1e-6)
    with pytest.raises(UsageError, match="no joint leads to the link 'flang'; did you mean flange"):
        read_urdf(text.encode(), 3, "flang")
    with pytest.raises(UsageError, match="--tip needs --geometry"):
        with_urdf(TABLE, None, "flange")


def test_arm_that_urdf_cannot_describe_is_refused_with_the_reason() -> None:
    table = TABLE._replace(robot=Robot(Dimensions(((0.0, 0.0, 1.0, 0.0, ((0, 0.5),)),))))
    with pytest.raises(UsageError, match="edition mycobot280: not every link is turned by its own"):
        write_urdf(table)
    with pytest.raises(
        UsageError, match="edition mycobot280: the geometry of this arm is not known"
    ):
        write_urdf(table._replace(robot=Robot()))
    with pytest.raises(UsageError, match="prefix is '1 <'; allowed: letters, digits and _"):
        write_urdf(TABLE, "1 <")


def test_subcommand_writes_the_urdf_to_a_file_or_standard_output(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    printed = cobotwire("urdf", "mycobot320")
    written = cobotwire("urdf", "mycobot320", "-o", path)
    assert printed.stdout == path.read_text() == write_urdf(editions.load("mycobot320").TABLE)
    assert written.stderr == f"wrote {path}\n"
    refused = cobotwire("urdf", "mycobot320", "-o", tmp_path)
    assert (refused.returncode, refused.stderr) == (2, f"cobotwire: {tmp_path}: Is a directory\n")
    assert "maker's ROS model" in cobotwire("urdf", "mypalletizer260").stderr


@pytest.fixture
def urdf(tmp_path: Path) -> str:
    path = tmp_path / "$arm.urdf"
    path.write_text(write_urdf(TABLE))
    return str(path)


def test_geometry_of_a_urdf_is_marked_as_unverified_wherever_it_shows(urdf: str) -> None:
    table = with_urdf(PRO_630, urdf)
    assert geometry_of(table) == MYCOBOT_280
    remark = f"the geometry is that of {urdf}, unverified"
    assert Lines().serving("/dev/pts/1", table) == f"/dev/pts/1\nnote     {remark}"
    assert json.loads(JsonLines().serving("/dev/pts/1", table))["geometry"] == remark
    assert TABLE.robot.geometry_remark == ""
    with staged(Options(None, "pro630", geometry=urdf, open_browser=False)) as stage:
        assert stage.hello(Viewer())["robot"]["geometryRemark"] == remark
        assert stage.simulated is not None
        assert stage.simulated.table == table
        assert geometry_of(stage.table) is None, "no check uses the geometry of a user"


def test_sim_answers_with_the_coordinates_of_a_urdf(urdf: str) -> None:
    with started("sim", "--edition", "pro630", "--geometry", urdf, "--json") as sim:
        begun = json.loads(printed(sim))
        assert begun["geometry"].endswith("$arm.urdf, unverified")
        with Pro630(begun["url"]) as arm:
            assert arm.get_coords() == pytest.approx(coords_of(MYCOBOT_280, [0] * 6), abs=0.2)
