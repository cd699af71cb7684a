"""The client in Rust, against the simulated arm; `make rust-package` runs the rest of its tests."""

from __future__ import annotations

import os
import re
import subprocess
import tomllib
from functools import lru_cache
from pathlib import Path

import pytest

from cobotwire.editions import clients
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire_codegen.targets.rust import camel, identifier, rustdoc
from probe import needed

ROOT = Path(__file__).parent.parent.parent
CRATE = ROOT / "rust/client"


@lru_cache
def example(name: str) -> str:
    """Return the path of a compiled example of the crate."""
    if not (CRATE / "src/editions/mycobot280.rs").exists():
        pytest.skip("needs the generated editions: cobotwire-gen --rust-data")
    words = ("cargo", "build", "--quiet", "-p", "cobotwire", "--features", "mycobot280")
    done = subprocess.run(
        [*words, "--example", name], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return str(ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "debug/examples" / name)


@needed
def test_first_program_moves_simulated_arm() -> None:
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        done = subprocess.run(
            [example("first"), server.url], capture_output=True, text=True, check=False
        )
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"\[(-?[\d.]+(, )?){6}\]\n", done.stdout)


@needed
def test_first_program_names_port_that_cannot_be_opened() -> None:
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        url = server.url
    done = subprocess.run([example("first"), url], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert f'LinkError {{ message: "{url}: cannot be opened: Connection refused' in done.stderr


@pytest.mark.parametrize("page", ["README.md", "docs/rust.md"])
def test_page_shows_first_program(page: str) -> None:
    program = (CRATE / "examples/first.rs").read_text().partition("\n\n")[2]
    assert len(program.splitlines()) == 8
    assert f"```rust\n{program}```" in (ROOT / page).read_text()


def test_crate_has_feature_for_each_edition() -> None:
    features = tomllib.loads((CRATE / "Cargo.toml").read_text())["features"]
    names = {path.parent.name for path in Path(clients.__file__).parent.glob("*/edition.json")}
    assert features.keys() - {"serial", "tokio"} == names
    in_lib = re.findall(r'feature = "(\w+)"', (CRATE / "src/lib.rs").read_text())
    assert names <= {*in_lib}


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
