"""The client in Rust, against the simulated arm; `make rust-package` runs the rest of its tests."""

from __future__ import annotations

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.editions import clients
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire_codegen.targets.rust import camel, identifier, rustdoc
from probe import needed, path
from probe_client import ProbeClient

ROOT = Path(__file__).parent.parent.parent
CRATE = ROOT / "rust/client"


def first() -> str:
    """Return the path of the example."""
    if not (CRATE / "src/editions/mycobot280.rs").exists():
        pytest.skip("needs the generated editions: cobotwire-gen --rust-data")
    return path("examples/first")


@needed
def test_first_program_moves_simulated_arm() -> None:
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        done = subprocess.run([first(), server.url], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"\[(-?[\d.]+(, )?){6}\]\n", done.stdout)


@needed
def test_first_program_names_port_that_cannot_be_opened() -> None:
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        url = server.url
    done = subprocess.run([first(), url], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert f'LinkError {{ message: "{url}: cannot be opened: Connection refused' in done.stderr


WRONG_ADDRESSES = [
    *[("mybuddy", given) for given in ("HEAD", 7, 300, "")],
    *[("mycobot280", given) for given in ("LEFT", 7)],
    ("mybuddy", "waist"),  # which has no joints to read
]


@needed
@pytest.mark.parametrize(("edition", "given"), WRONG_ADDRESSES)
def test_wrong_address_is_refused_in_the_words_of_python(edition: str, given: int | str) -> None:
    table = editions.load(edition).TABLE
    with pytest.raises(UsageError) as expected:
        RequestEncoder(codecs.load(table), find_address(table, given)).encode("get_angles", ())
    server = TcpServer(SimulatedArm(table).connect)
    with server, pytest.raises((LinkError, UsageError)) as refused:
        with ProbeClient(server.url, edition, address=str(given)) as client:
            client.get_angles()
    assert str(refused.value) == str(expected.value)


@pytest.mark.parametrize("page", ["README.md", "docs/rust.md"])
def test_page_shows_first_program(page: str) -> None:
    program = (CRATE / "examples/first.rs").read_text().partition("\n\n")[2]
    assert len(program.splitlines()) == 8
    assert f"```rust\n{program}```" in (ROOT / page).read_text()


def test_crate_has_feature_for_each_edition() -> None:
    features = tomllib.loads((CRATE / "Cargo.toml").read_text())["features"]
    names = {path.parent.name for path in Path(clients.__file__).parent.glob("*/edition.json")}
    assert features.keys() - {"serial", "tokio", "editions"} == names


def test_text_of_spec_does_not_leave_its_comment() -> None:
    shown = rustdoc("a\nfn evil() {}\r\u2028fn more() {}\u202e")
    assert all(line.startswith("///") for line in shown.split("\n"))
    assert "\u202e" not in shown


@pytest.mark.parametrize(
    ("name", "made"),
    [("POWER_ON", "PowerOn"), ("A", "A"), ("V1_2", "V1_2"), ("SELF", "Self_"), ("RX", "Rx")],
)
def test_member_of_enum_has_name_of_rust(name: str, made: str) -> None:
    assert camel(name) == made


def test_keyword_becomes_raw_identifier() -> None:
    assert (identifier("type"), identifier("crate")) == ("r#type", "crate_")
