"""Wrong uses of typed messages, each in a line that ends in `# type: ignore`."""

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
    GetEncoder()  # type: ignore
    GetEncoder("2")  # type: ignore
    GetEncoder(2, 3)  # type: ignore
    GetEncoder(servo=2)  # type: ignore
    SendAngles([0, 0, 0, 0, 0, 0], speed="fast")  # type: ignore
    GetEncoder(2).joint = 3  # type: ignore
    print(GetEncoder(2).servo)  # type: ignore
    text: str = client._call(GetEncoder(2))  # type: ignore
    print(client._call(GetAngles()).j7)  # type: ignore
    client._send(GetAngles())  # type: ignore
    client._call(GetEncoderReply(2))  # type: ignore
    print(text)


def replies(reply: GetEncoderReply | GetAnglesReply) -> None:
    """Misuse fields of replies, also after a match."""
    print(reply.encoder)  # type: ignore
    GetAnglesReply(1)  # type: ignore
    match reply:
        case GetEncoderReply(encoder):
            print(encoder.j1)  # type: ignore
        case GetAnglesReply(angles):
            print(angles.x)  # type: ignore
