"""Typed messages that mypy and pyright must accept, each with the stated type."""

from typing import assert_type

from cobotwire.client import Client
from cobotwire.codec.interface import DecodedMessage
from cobotwire.editions import mycobot, mycobot280
from cobotwire.editions.mycobot280 import (
    Angles,
    Coords,
    FreshMode,
    GetAngles,
    GetAnglesCoords,
    GetAnglesCoordsReply,
    GetAnglesReply,
    GetEncoder,
    GetEncoderReply,
    GetFreshMode,
    GetSsidPwd,
    MyCobot280,
    SendAngles,
    SetColor,
    SetColorReply,
    SetSsidPwd,
    WifiAccount,
)
from cobotwire.protocol.messages import Reply, Request


def results(client: Client, arm: MyCobot280) -> None:
    """Check that a request has the result type of the method of the same command."""
    assert_type(client._call(GetEncoder(2)), int)
    assert_type(client._call(GetAngles()), Angles)
    assert_type(client._call(GetFreshMode()), FreshMode)
    assert_type(client._call(GetSsidPwd()), WifiAccount)
    angles, coords = client._call(GetAnglesCoords())
    assert_type(angles, Angles)
    assert_type(coords, Coords)
    assert_type(arm.get_angles(), Angles)
    assert_type(arm.get_fresh_mode(), FreshMode)
    client._send(SetColor(1, 2, 3), ack_within=0.5)
    client._send(SetSsidPwd(account="a", password="b"))


def fields(request: SendAngles, reply: GetEncoderReply) -> None:
    """Check that fields are attributes with the types of the spec."""
    assert_type(request.speed, int)
    assert_type(reply.encoder, int)
    assert_type(reply.result, int)
    assert_type(SetColorReply().done, int | None)
    assert_type(GetAnglesReply(Angles(0, 0, 0, 0, 0, 0)).result, Angles)
    SendAngles([0, 0, 0, 0, 0, 0], speed=30)
    SendAngles(request.angles, 30)


def matched(decoded: DecodedMessage) -> object:
    """Match a decoded message by its type, and its fields by place or name."""
    message: Request[object] | Reply[object] = decoded.typed
    match message:
        case GetEncoder(joint):
            assert_type(joint, int)
            return joint
        case GetAnglesReply(angles=angles):
            assert_type(angles, Angles)
            return angles.j1
        case GetAnglesCoordsReply(angles, coords):
            assert_type(angles, Angles)
            assert_type(coords, Coords)
            return coords.x
        case SendAngles(speed=speed):
            assert_type(speed, int)
            return speed
        case _:
            return None


def shared(client: Client) -> None:
    """Check that two editions share the classes of messages that are equal in both."""
    request: mycobot.GetAngles = mycobot280.GetAngles()
    assert_type(client._call(request), mycobot.Angles)
