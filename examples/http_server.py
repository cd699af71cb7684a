"""Control an arm over HTTP, with asyncio: http_server.py PORT [TCP-PORT].

    curl localhost:8080/angles                        read the joints
    curl -X POST localhost:8080/angles -d '[0,20,0,0,0,0]'    move there; replies when it is there
    curl -X POST localhost:8080/stop                  stop the arm, also during a motion

It listens only on this machine and needs no password: every program on this machine can move the
arm. Each connection has a task of its own. All tasks share one client, which sends `stop` at once.
"""

import asyncio
import json
import sys
from typing import Any

from cobotwire import AsyncMyCobot280
from cobotwire.protocol.errors import CobotwireError, UsageError

SPEED = 50  # percent


async def main(port: str, tcp_port: int = 8080) -> None:
    """Serve until Ctrl-C, which stops the arm."""
    async with AsyncMyCobot280(port) as arm:
        await arm.power_on()

        async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            try:
                method, path, body = await receive(reader)
                status, reply = await respond(arm, method, path, body)
                text = json.dumps(reply).encode()
                writer.write(f"HTTP/1.0 {status}\r\nContent-Length: {len(text)}\r\n\r\n".encode())
                writer.write(text)
                await writer.drain()
            except (OSError, ValueError, EOFError):
                pass  # not HTTP, or the client is gone
            finally:
                writer.close()

        server = await asyncio.start_server(serve, "127.0.0.1", tcp_port)
        print(f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}", flush=True)
        async with server:
            await server.serve_forever()


async def receive(reader: asyncio.StreamReader) -> tuple[str, str, bytes]:
    """Return the method, the path and the body of a request."""
    method, path, _ = (await reader.readline()).decode().split()
    size = 0
    while (line := (await reader.readline()).decode().strip()) != "":
        name, _, value = line.partition(":")
        if name.lower() == "content-length":
            size = int(value)
    return method, path, await reader.readexactly(size)


async def respond(arm: AsyncMyCobot280, method: str, path: str, body: bytes) -> tuple[str, Any]:
    """Do what a request says; return the status and the reply."""
    try:
        match method, path:
            case "GET", "/angles":
                return "200 OK", await arm.get_angles()
            case "POST", "/angles":
                await arm.move_angles(json.loads(body), SPEED)
                return "200 OK", await arm.get_angles()
            case "POST", "/stop":
                await arm.stop()
                return "200 OK", "stopped"
        return "404 Not Found", f"no {method} {path}"
    except (UsageError, json.JSONDecodeError) as error:
        return "400 Bad Request", str(error)
    except CobotwireError as error:
        return "502 Bad Gateway", str(error)


if __name__ == "__main__":
    try:
        asyncio.run(main(sys.argv[1], *map(int, sys.argv[2:])))
    except KeyboardInterrupt:
        print("stopped")
