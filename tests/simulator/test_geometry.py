"""Test that the simulated arm takes its geometry from the edition, whatever the edition's name."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import in_process
from cobotwire import editions
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.kinematics import geometry_of
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire_codegen.cli import main
from in_process import Ended

SPEC = Path(__file__).parents[2] / "spec" / "editions"
DELTA = """\
edition: {name}
class: Longer
title: A delta of the 280
doc: An arm that differs from the 280 in little.
base: {base}/mycobot280.yaml
{own}
"""
LONGER = """\
geometry:
  links:
    - {offset: 0, alpha: 90, a: 0, d: 1131.22}
    - {offset: -90, alpha: 0, a: -110.4, d: 0}
    - {offset: 0, alpha: 0, a: -96, d: 0}
    - {offset: -90, alpha: 90, a: 0, d: 64.62}
    - {offset: 90, alpha: -90, a: 0, d: 73.18}
    - {offset: 0, alpha: 0, a: 0, d: 48.6}
  doc: It stands on a pedestal of a metre.
encoders: {ticks: 4096, zero: 2048, highest: 4096, signs: [1, 1, 1, 1, 1, 1], doc: All count up.}
"""


def _built(folder: Path, name: str, own: str = "") -> Ended:
    (folder / f"{name}.yaml").write_text(DELTA.format(name=name, base=SPEC, own=own))
    words = ("build", f"{name}.yaml", "--out", name)
    return in_process.run(main, "cobotwire-gen", *words, folder=folder)


@pytest.mark.parametrize(
    ("name", "own", "height", "encoder"),
    [("arm_like_the_280", "", 0.0, 1820), ("arm_on_a_pedestal", LONGER, 1000.0, 2276)],
)
def test_delta_of_the_280_keeps_or_states_its_geometry(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    own: str,
    height: float,
    encoder: int,
) -> None:
    made = _built(tmp_path, name, own)
    assert made.returncode == 0, made.stderr
    monkeypatch.syspath_prepend(tmp_path)
    package: Any = import_module(name)
    today: Any = editions.load("mycobot280")
    coords, encoders = [], []
    for each in (package, today):
        simulated = SimulatedArm(each.TABLE, powered=True)
        simulated.state.angles.place((20.0, -40.0, 30.0, 10.0, 15.0, 5.0), simulated.clock())
        with PtyServer(simulated) as server, each.CLIENT(server.url) as arm:
            coords.append(tuple(arm.get_coords()))
            encoders.append(arm.get_encoder(1))
    assert any(coords[1][:3])
    assert coords[0] == pytest.approx([*coords[1][:2], coords[1][2] + height, *coords[1][3:]])
    assert encoders == [encoder, 1820]


@pytest.mark.parametrize(
    "own",
    [
        LONGER.replace("[1, 1, 1, 1, 1, 1]", "[1, 1, 1, 1, 1]"),
        LONGER.replace("[1, 1, 1, 1, 1, 1]", "[1, 1, 1, 1, 1, 2]"),
        LONGER.replace("    - {offset: 0, alpha: 90, a: 0, d: 1131.22}\n", ""),
        LONGER.replace("d: 48.6", "d: long"),
    ],
)
def test_geometry_that_does_not_fit_the_joints_is_rejected(tmp_path: Path, own: str) -> None:
    made = _built(tmp_path, "wrong_arm", own)
    assert made.returncode != 0
    assert "bad-number" in made.stdout + made.stderr


def test_delta_with_other_joints_does_not_inherit_the_geometry(tmp_path: Path) -> None:
    made = _built(tmp_path, "wrong_arm", "joints: 5")
    assert "geometry" not in made.stdout + made.stderr


def test_geometry_is_exact_and_belongs_to_no_name() -> None:
    known = geometry_of(TABLE)
    assert known is not None
    assert (known.links[0].d, known.links[1].a, known.links[5].d) == (131.22, -110.4, 48.6)
    assert geometry_of(TABLE._replace(edition="another")) == known
    assert geometry_of(TABLE._replace(robot=TABLE.robot._replace(geometry=None))) is None
