"""Uses of typed messages that mypy and pyright must reject: the lines that end in `# wrong`."""

from cobotwire.client import Client
from cobotwire.editions.mycobot280 import (
    GetAngles,
    GetAnglesReply,
    GetEncoder,
    GetEncoderReply,
    SendAngles,
)


def requests(client: Client) -> None:
    """Pass wrong arguments: types, number and names."""
    GetEncoder()  # wrong
    GetEncoder("2")  # wrong
    GetEncoder(2, 3)  # wrong
    GetEncoder(servo=2)  # wrong
    SendAngles([0, 0, 0, 0, 0, 0], speed="fast")  # wrong
    GetEncoder(2).joint = 3  # wrong
    print(GetEncoder(2).servo)  # wrong
    text: str = client._call(GetEncoder(2))  # wrong
    print(client._call(GetAngles()).j7)  # wrong
    client._send(GetAngles())  # wrong
    client._call(GetEncoderReply(2))  # wrong
    print(text)


def replies(reply: GetEncoderReply | GetAnglesReply) -> None:
    """Misuse fields of replies, also after a match."""
    print(reply.encoder)  # wrong
    GetAnglesReply(1)  # wrong
    match reply:
        case GetEncoderReply(encoder):
            print(encoder.j1)  # wrong
        case GetAnglesReply(angles):
            print(angles.x)  # wrong
