"""MCAP files hold all messages in the order of their times, and messages of ROS 2."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import pyarrow as pa
import pytest
from mcap.reader import make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from capture.export.exporting import START, export, polled, recording, reply
from cobotwire.capture import Packet
from cobotwire.capture.export import ExportPlan, Message
from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.formats.mcap_file import open_sink
from cobotwire.capture.export.tables import TIME
from cobotwire.editions import load
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.kinematics import flange, geometry_of
from cobotwire.protocol.errors import UsageError


class Written(NamedTuple):
    schema: str
    topic: str
    time_ns: int
    content: Any


def written(path: Path) -> list[Written]:
    """Return the messages of a file, read as the schema of the channel says; CDR by rosbags."""
    found = []
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert schema is not None
            if schema.encoding == "ros2msg":
                assert channel.message_encoding == "cdr"
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(schema.data.decode(), schema.name))
                content = store.deserialize_cdr(message.data, schema.name)
            else:
                assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
                content = json.loads(message.data)
                jsonschema.validate(content, json.loads(schema.data))
            found.append(Written(schema.name, channel.topic, message.log_time, content))
    return found


@pytest.fixture
def arm(tmp_path: Path) -> list[Written]:
    packets = [*polled(3), Packet(START + 10**9, "received", reply("is_power_on", 1))]
    report = export(
        tmp_path / "arm.mcap", recording(tmp_path / "arm.pcapng", packets), format="mcap"
    )
    assert report.rows.total() == 7
    return written(tmp_path / "arm.mcap")


def test_each_message_of_each_robot_is_a_channel(arm: list[Written]) -> None:
    assert {(each.topic, each.schema) for each in arm} == {
        ("/arm/get_angles/request", "cobotwire.get_angles.request"),
        ("/arm/get_angles/reply", "cobotwire.get_angles.reply"),
        ("/arm/is_power_on/reply", "cobotwire.is_power_on.reply"),
        ("/arm/joint_states", "sensor_msgs/msg/JointState"),
        ("/arm/tf", "tf2_msgs/msg/TFMessage"),
    }
    assert arm[-1].content == {"powered": True}


def test_joint_states_are_in_radians(arm: list[Written]) -> None:
    states = [each for each in arm if each.schema == "sensor_msgs/msg/JointState"]
    second = states[1].content
    assert (second.header.stamp.sec, second.header.stamp.nanosec) == (START // 10**9, 23_000_000)
    assert second.name == ["j1", "j2", "j3", "j4", "j5", "j6"]
    assert list(second.position) == pytest.approx(
        [math.radians(0.01 + joint) for joint in range(6)]
    )


def test_pose_of_the_end_is_computed_from_the_joints(tmp_path: Path) -> None:
    angles = [10.0, -20.0, 30.0, -40.0, 50.0, -60.0]
    packets = [Packet(START, "received", reply("get_angles", angles))]
    export(tmp_path / "arm.mcap", recording(tmp_path / "a.pcapng", packets), format="mcap")
    (tf,) = [e.content for e in written(tmp_path / "arm.mcap") if e.topic.endswith("/tf")]
    (moved,) = tf.transforms
    geometry = geometry_of(load().TABLE)
    assert geometry is not None
    expected = flange(geometry, angles)
    assert (moved.header.frame_id, moved.child_frame_id) == ("base", "a/end")
    position, turn = moved.transform.translation, moved.transform.rotation
    assert [position.x * 1000, position.y * 1000, position.z * 1000] == pytest.approx(
        expected.origin
    )
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    assert math.hypot(x, y, z, w) == pytest.approx(1)
    # The axes of the rotation that the quaternion stands for.
    assert [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)] == pytest.approx(
        expected.x
    )
    assert [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)] == pytest.approx(
        expected.y
    )


def test_values_that_json_lacks_are_hex_or_null(tmp_path: Path) -> None:
    values = {"data": [b"\xfe\x01"], "force": [1.5, math.nan, -math.inf]}
    table = pa.table({"time": pa.array([START], TIME), **{k: [v] for k, v in values.items()}})
    plan = ExportPlan(str(tmp_path), InstalledEditions(), format="mcap")
    with (tmp_path / "a.mcap").open("wb") as file:
        sink = open_sink(file, None, plan)
        sink.write([Batch(Message("measure", "reply"), "mycobot280", "arm", table)])
        sink.close()
    with (tmp_path / "a.mcap").open("rb") as file:
        (message,) = [message for _, _, message in make_reader(file).iter_messages()]
    assert json.loads(message.data) == {"data": ["fe01"], "force": [1.5, None, None]}


def test_raw_bytes_have_no_times_for_an_mcap_file(tmp_path: Path) -> None:
    (tmp_path / "arm.bin").write_bytes(reply("is_power_on", 1))
    with pytest.raises(UsageError, match="without times, which an MCAP file needs"):
        export(tmp_path / "arm.mcap", tmp_path / "arm.bin", format="mcap")


def test_partitioned_export_writes_an_mcap_file_for_each_robot_and_day(tmp_path: Path) -> None:
    recording(tmp_path / "left.pcapng", polled(2))
    recording(tmp_path / "right.pcapng", polled(2))
    export(
        tmp_path / "out",
        *sorted(tmp_path.glob("*.pcapng")),
        format="mcap",
        partition=("robot", "day"),
    )
    found = sorted(
        path.relative_to(tmp_path / "out").as_posix() for path in tmp_path.rglob("*.mcap")
    )
    assert found == [
        "robot=left/day=2026-11-23/messages.mcap",
        "robot=right/day=2026-11-23/messages.mcap",
    ]
