"""A robot with two arms, each on a port of its own, for asyncio."""

from __future__ import annotations

from types import TracebackType
from typing import Generic, Self, TypeVar, Unpack

from cobotwire.client.aio import AsyncClient
from cobotwire.client.opening import SharedOptions
from cobotwire.transport import Transport

ArmT = TypeVar("ArmT", bound=AsyncClient)


class AsyncTwoArms(Generic[ArmT]):
    """Two clients of one class, ``left`` and ``right``, which are opened and closed together.

        async with AsyncTwoArms(AsyncMercuryX1, "/dev/left_arm", "/dev/right_arm") as robot:
            await robot.left.get_angles()
            await robot.right.move_angles([0, 0, 0, -90, 0, 90, 0], speed=20)

    ``async with`` or :meth:`open` opens both ports. An exception that leaves the block stops both
    arms once, then closes both ports.

    Attributes:
        left: the client of the left arm.
        right: the client of the right arm.
    """

    def __init__(
        self,
        client: type[ArmT],
        left: str | Transport,
        right: str | Transport,
        **options: Unpack[SharedOptions],
    ) -> None:
        """Store the arguments; :meth:`open` opens both ports.

        Args:
            client: the class of both clients.
            left: the port of the left arm, as the client takes it.
            right: the port of the right arm.
            options: ``baudrate``, ``timeout``, ``deadline``, ``retry``, ``limits``, ``codec`` and
                ``on_error`` of both clients; see :class:`cobotwire.client.Client`.

        Raises:
            UsageError: an argument is not allowed.
            LinkError: a port does not exist, or cannot be opened.
        """
        self.left = client(left, **options)
        self.right = client(right, **options)

    # unasync: off
    async def open(self) -> None:
        """Open both ports, unless they are open. If one cannot be opened, both are closed.

        Raises:
            UsageError: a port or the baud rate is not allowed.
            LinkError: a port does not exist, or cannot be opened.
        """
        try:
            await self.left.open()
            await self.right.open()
        except BaseException:
            await self.close()
            raise

    # unasync: on
    async def close(self) -> None:
        """Close both ports, even if closing one fails. Nothing is sent to the arms."""
        try:
            await self.left.close()
        finally:
            await self.right.close()

    async def __aenter__(self) -> Self:
        await self.open()  # unasync: off
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            if error is not None:
                # Both arms are stopped before a port is closed; the right one is stopped on exit.
                await self.left._stop_all_for(error)
        finally:
            try:
                await self.right.__aexit__(kind, error, traceback)
            finally:
                await self.left.__aexit__(kind, error, traceback)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} left={self.left!r} right={self.right!r}>"
