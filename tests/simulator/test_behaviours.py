"""Devices of other packages: their behaviours, and what they do without any."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.conformance.device.read_back import settings_of
from cobotwire.protocol.effects import Stores, effect_of, states_of
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.behaviour import Sized, external, own
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.render import render_python
from command_line import printed, started
from trial_specs import HEAD, package_of

LAMP = Path(__file__).parent.parent / "codegen" / "lamp.yaml"
GETTER = """
  get_mode:
    id: 0x11
    title: Read the mode
    doc: Reads how a channel shines.
    safety: query
    effect: {reports: mode, at: channel}
    request: [{name: channel, type: channel}]
    reply: [{name: mode, type: mode}]
"""
BEHAVIOURS_MODULE = """
from cobotwire.simulator.behaviour import Behaviours
from bedside import messages as m

behaviours = Behaviours()

@behaviours.behaviour(m.SetMode)
def set_mode(arm, now, request):
    arm.kept[request.channel] = request.mode

@behaviours.behaviour(m.GetWarmth)
def get_warmth(arm, now, request):
    blinks = arm.kept.get(request.channel) == 1
    return m.GetWarmthReply(warmth=21.5 if blinks else 40.0)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Generate a package and its behaviours outside of the repository."""
    folder = tmp_path_factory.mktemp("bedside")
    text = LAMP.read_text().replace(
        "safety: setting", "safety: setting\n    effect: {stores: {mode: mode}, at: channel}", 1
    )
    text = text.replace(
        "joints: 0\n", "joints: 0\nstate:\n  mode: {type: mode, each: channel}\n", 1
    )
    at = text.index("vectors:")
    vectors = (
        "\n  - {name: m, command: get_mode, direction: request, frame: FE FE 03 11 01 FA, "
        "values: {channel: 1}}"
        "\n  - {name: n, command: get_mode, direction: reply, frame: FE FE 03 11 01 FA, "
        "values: {mode: BLINK}}\n"
    )
    (folder / "lamp.yaml").write_text(
        f"{text[:at].rstrip()}{GETTER}\n{text[at:].rstrip()}{vectors}"
    )
    edition = build_edition(folder / "lamp.yaml", folder)
    check(edition)
    write(Target(folder / "bedside", render_python(edition)))
    (folder / "bedside_behaviours.py").write_text(BEHAVIOURS_MODULE)
    sys.path.insert(0, str(folder))
    importlib.invalidate_caches()
    yield folder
    sys.path.remove(str(folder))
    for name in [name for name in sys.modules if name.partition(".")[0].startswith("bedside")]:
        del sys.modules[name]


@pytest.fixture
def bedside(folder: Path) -> ModuleType:
    return importlib.import_module("bedside")


@pytest.mark.parametrize("server_type", [PtyServer, TcpServer])
def test_device_of_another_package_behaves_as_its_module_says(
    bedside: Any, server_type: Any
) -> None:
    arm = SimulatedArm(bedside.TABLE, behaviours=external.named("bedside_behaviours"))
    peer = arm if server_type is PtyServer else arm.connect
    with server_type(peer) as server, bedside.CLIENT(server.url) as lamp:
        assert lamp.get_warmth(2) == 40.0
        lamp.set_mode(2, bedside.Mode.BLINK)
        assert lamp.get_warmth(2) == 21.5


def test_installed_package_provides_the_behaviours_of_its_edition(
    folder: Path, bedside: Any
) -> None:
    info = folder / "bedside-1.dist-info"
    info.mkdir(exist_ok=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: bedside\nVersion: 1\n")
    points = f"[{external.GROUP}]\nlamp = bedside_behaviours:behaviours\n"
    (info / "entry_points.txt").write_text(points)
    external.installed.cache_clear()
    try:
        client = SimulatedArm(bedside.TABLE)
        assert client.receive(bytes.fromhex("FE FE 03 20 02 FA")) == bytes.fromhex(
            "FE FE 05 20 02 01 90 FA"
        )
    finally:
        (info / "entry_points.txt").unlink()
        external.installed.cache_clear()


def test_without_behaviours_what_a_setter_sets_is_reported_by_its_query(bedside: Any) -> None:
    arm = SimulatedArm(bedside.TABLE, behaviours={})
    for request in ("FE FE 04 10 02 01 FA", "FE FE 04 10 03 00 FA"):
        assert arm.receive(bytes.fromhex(request)) == b""
    reports = [arm.receive(bytes((254, 254, 3, 0x11, channel, 250)))[4] for channel in (1, 2, 3)]
    assert reports == [0, 1, 0]
    arm.restart()
    assert arm.receive(bytes.fromhex("FE FE 03 11 02 FA"))[4] == 0


@pytest.mark.parametrize("name", editions.names())
def test_what_a_setter_stores_is_what_its_query_reports_in_every_edition(name: str) -> None:
    table: Table = editions.load(name).TABLE
    settings = [setting for command in table.commands for setting in settings_of(table, command)]
    declared = set(states_of(table)) | {"free", "lowest", "highest"}
    stored = [
        each
        for each in settings
        if isinstance(effect := effect_of(each.command), Stores)
        and declared.issuperset(effect.values.values())
    ]
    assert stored
    for setting in stored:
        arm = SimulatedArm(table, powered=True)
        fields = {field.name: _highest(field) for field in setting.variant.fields}
        fields |= dict(setting.part)
        if setting.command.request_text is not None:
            fields |= dict.fromkeys(setting.command.request_text.fields, "text")
        device = arm.receivers(None)[0]
        arm.perform(setting.command, fields, device)
        asked = {f.name: fields[f.name] for f in setting.query_variant.fields}
        found: Any = arm.perform(setting.query, asked, device)
        reply = found.reply.fields if isinstance(found, Sized) else found
        for reported, argument in setting.pairs:
            low_byte = isinstance(found, Sized) and found.size == 1
            wanted = fields[argument] % 256 if low_byte else fields[argument]
            came = reply[reported] if setting.place is None else reply[reported][setting.place]
            assert came == wanted, (setting.command.name, reported)


def _highest(field: Any) -> Any:
    values = tuple(
        number.physical(field.choices[-1] if field.choices else number.maximum)
        for number in field.cases[0].numbers
    )
    return values if field.many else values[0]


@pytest.mark.parametrize(
    ("module", "message"),
    [
        ("nosuch_module", "the module nosuch_module cannot be imported: No module named"),
        ("nosuch.py", "nosuch.py: no such file"),
        ("json", "json (behaviours) is not a Behaviours of cobotwire.simulator.behaviour"),
    ],
)
def test_module_without_behaviours_is_refused(module: str, message: str) -> None:
    with pytest.raises(UsageError, match="^" + message.replace("(", r"\(").replace(")", r"\)")):
        external.named(module)


def test_sim_takes_the_behaviours_of_a_file(folder: Path) -> None:
    own = ("--behaviours", folder / "bedside_behaviours.py")
    with started("--edition", folder / "bedside", "sim", "--tcp", "127.0.0.1:0", *own) as sim:
        package: Any = importlib.import_module("bedside")
        with package.CLIENT(printed(sim).split()[-1]) as lamp:
            assert lamp.get_warmth(2) == 40.0


@pytest.mark.parametrize("base", ["mercury_x1", "mybuddy", "mycobot280"])
def test_delta_with_a_name_of_its_own_behaves_as_its_base(base: str, tmp_path: Path) -> None:
    with package_of(f"{HEAD}base: cobotwire:{base}\n", tmp_path) as package:
        table = editions.load(base).TABLE
        assert package.TABLE.bases == (base, *table.bases)
        for command in table.commands:
            assert own(package.TABLE, package.TABLE.command(command.name)) is own(table, command)
