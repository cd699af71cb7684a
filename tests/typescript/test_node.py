"""The npm package in Node, against simulated arms over TCP."""

from __future__ import annotations

import json
import re
import socket
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import npm_package
from cobotwire import MyCobot280, UsageError
from cobotwire.editions import mycobot280, pro630
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm, TcpServer
from targets.typescript.comparison import package

HERE = Path(__file__).parent
pytestmark = pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
ANGLES = bytes.fromhex("FEFE0220FA")


def talk(name: str, url: str) -> list[Any]:
    """Run a conversation, and return what it printed."""
    package()
    words = ("node", HERE / "conversations.mjs", name, url)
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def talk_with_arm(name: str, table: Table = mycobot280.TABLE) -> tuple[list[Any], SimulatedArm]:
    """Run a conversation with a simulated arm; return what it printed, and the arm."""
    arm = SimulatedArm(table)
    with TcpServer(arm.connect) as server:
        return talk(name, server.url), arm


@contextmanager
def peer(serve: Callable[[socket.socket], object]) -> Iterator[str]:
    """Serve one connection after another with a function, in a thread."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def accept() -> None:
            while True:
                try:
                    connection, _ = listener.accept()
                except OSError:
                    return
                with connection:
                    serve(connection)

        thread = threading.Thread(target=accept)
        thread.start()
        yield f"socket://127.0.0.1:{listener.getsockname()[1]}"
        listener.shutdown(socket.SHUT_RDWR)
    thread.join()


def read_all(connection: socket.socket) -> bytes:
    """Return what a client sends until it closes the connection."""
    return b"".join(iter(lambda: connection.recv(4096), b""))


def test_methods_return_values_with_their_types() -> None:
    [[powered, angles, names, size, fields]], _ = talk_with_arm("results")
    assert powered is True
    assert angles == [0.0] * 6
    assert (names, size) == (["angles", "coords"], 6)
    assert fields == {"encoder": 2048}


def test_errors_have_the_texts_of_python() -> None:
    [found], _ = talk_with_arm("mistakes")
    with TcpServer(SimulatedArm(mycobot280.TABLE).connect) as server, MyCobot280(server.url) as arm:
        texts = []
        for arguments in (([0, 200, 0, 0, 0, 0], 30), ([0] * 5, 30)):
            with pytest.raises(UsageError) as caught:
                arm.send_angles(*arguments)
            texts.append(str(caught.value))
    assert [text for _, text in found[:2]] == texts
    assert {name for name, _ in found} == {"UsageError", "LinkError"}
    expected = [
        "missing its argument speed",
        "speed is 60; allowed: a whole number 1..50 percent",
        "2.5",
        "takes 0 arguments, not 1",
        "timeout is -1; allowed: seconds above 0 and below 3600",
        "socket://127.0.0.1:1: cannot be opened: connect ECONNREFUSED",
        "/dev/nowhere is a serial port, which needs: npm install serialport",
        "send_angle is not a query; a stream can send only queries",
    ]
    for text, (_, shown) in zip(expected, found[2:], strict=True):
        assert text in shown


def test_call_without_reply_times_out_and_close_ends_waiting_call() -> None:
    with peer(read_all) as url:
        [[error, is_timeout, attempts, waited], [waiting, after, again]] = talk("silence", url)
    assert error[0] == "ReplyTimeout"
    assert error[1].startswith("no reply to get_angles() within 0.2")
    assert (is_timeout, attempts, waited, again) == (True, 2, True, None)
    assert waiting == after == ["LinkError", f"{url}: is closed"]


def test_aborted_call_ends_with_reason_of_signal() -> None:
    with peer(read_all) as url:
        assert talk("aborted", url) == [True, True, True]


def test_queued_motion_is_not_sent_after_stop() -> None:
    move, stop = "fefe0f220000000000000000000003e80afa", "fefe0229fa"
    assert talk("queued", "") == [["memory: is closed", move, stop]]


def test_option_of_another_type_is_an_error_before_a_byte_is_sent() -> None:
    [[*found, sent]] = talk("options", "")
    names = ["limits.speed", *["limits.workspace"] * 3, "timeout", "deadline", "retry.attempts"]
    names += ["retry.grace", "onError", "seconds"]
    assert sent == []
    for name, (kind, text) in zip(names, found, strict=True):
        assert kind == "UsageError"
        assert text.startswith(f"{name} is ")


def test_port_of_browser_survives_a_wrong_byte_and_can_be_opened_again() -> None:
    lost = ["LinkError", "serial port 1: the peer has closed the connection"]
    assert talk("browser", "") == [[True, True, lost]]


def test_reply_that_came_while_the_program_computed_is_returned() -> None:
    def serve(connection: socket.socket) -> None:
        while connection.recv(6):
            connection.sendall(bytes.fromhex("FEFE043B0002FA"))

    with peer(serve) as url:
        assert talk("blocked", url) == [2]


def test_calls_that_run_at_once_get_their_own_replies() -> None:
    def serve(connection: socket.socket) -> None:
        while request := connection.recv(6):
            joint = request[4]
            connection.sendall(bytes([0xFE, 0xFE, 4, 0x3B, 0, joint, 0xFA]))

    with peer(serve) as url:
        assert talk("shared", url) == [[1, 2, 3, 4, 5, 6] * 2]


def test_stream_yields_samples_with_times() -> None:
    assert talk_with_arm("stream")[0] == [[10, True]]


def test_event_arrives_without_a_request() -> None:
    [[event, lost]], _ = talk_with_arm("events", pro630.TABLE)
    assert set(event) >= {"status"}
    assert lost == 0


def test_close_sends_the_last_request_whole() -> None:
    received: list[bytes] = []
    with peer(lambda connection: received.append(read_all(connection))) as url:
        assert talk("last", url) == []
    assert received == [bytes.fromhex("FEFE056A010203FA")]


def test_failed_run_stops_the_arm_unless_on_error_is_leave() -> None:
    received: list[bytes] = []
    with peer(lambda connection: received.append(read_all(connection))) as url:
        assert talk("stopped", url) == [[["Error", "mine"]] * 2]
    stop = bytes.fromhex("FEFE0229FA")
    assert [data.count(stop) for data in received] == [1, 0]


def test_lost_connection_ends_calls_with_link_error() -> None:
    received: list[bytes] = []

    def serve(connection: socket.socket) -> None:
        received.append(read_all(connection) if received else connection.recv(100))

    with peer(serve) as url:
        [found] = talk("lost", url)
    # The device may hold half a frame, which the next client ends.
    assert received[1].lstrip(b"\0").startswith(received[0])
    assert received[1][0] == 0
    assert found == [["LinkError", f"{url}: the peer has closed the connection"]] * 2


def test_late_reply_to_earlier_client_is_not_paired_with_request_of_next() -> None:
    answered = threading.Event()

    def serve(connection: socket.socket) -> None:
        if not answered.is_set():
            read_all(connection)
            answered.set()
            return
        connection.sendall(bytes.fromhex("FEFE043B0001FA"))  # the late reply
        while connection.recv(6):
            connection.sendall(bytes.fromhex("FEFE043B0002FA"))

    with peer(serve) as url:
        assert talk("late", url) == ["ReplyTimeout", 2]


def test_page_needs_no_module_of_node() -> None:
    for path in (package() / "dist").glob("*.js"):
        imports = re.findall(r"""(?:from|import)[ (]+["']([^"']+)""", path.read_text())
        assert path.name == "node.js" or all(each.startswith("./") for each in imports), path
        assert path.name == "node.js" or "./node.js" not in imports, path


def test_first_program_moves_simulated_arm() -> None:
    text = npm_package.program("first.mjs")
    assert len(text.splitlines()) == 8
    with TcpServer(SimulatedArm(mycobot280.TABLE).connect) as server:
        words = ("node", "--input-type=module", "--eval", text, "first", server.url)
        done = subprocess.run(words, cwd=package(), capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"-?[\d.]+ \[( -?[\d.]+,?){5} \]\n", done.stdout.replace("\n ", ""))


def test_program_of_the_docs_decodes_bytes() -> None:
    words = ("node", "--input-type=module", "--eval", npm_package.program("decode.mjs"))
    done = subprocess.run(words, cwd=package(), capture_output=True, text=True, check=True)
    assert done.stdout == "0 1 no-header \n1 6 is_power_on { powered: 1 }\n"


def test_page_loads_few_bytes() -> None:
    package()
    assert npm_package.loaded() <= npm_package.LARGEST
