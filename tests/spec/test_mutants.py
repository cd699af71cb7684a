"""A wrong fact in the spec is noticed: a sample of what ``make spec-mutants`` changes."""

from __future__ import annotations

import pytest

from cobotwire_codegen.load import Mapping, load
from spec_mutants.campaign import Task, run, tasks
from spec_mutants.nodes import changed
from spec_mutants.spec_files import PATHS, files, judged
from spec_mutants.survivors import accepted

SAMPLE = [
    "set_free_mode.safety: power -> query",
    "jog_rpy.safety: motion -> setting",
    "pause.effect.does: pause -> resume",
    "set_end_type.effect.stores: end_type -> reference_frame",
    "set_server_port.effect.stores: server_port -> ",
    " commands/power.yaml: commands.power_on.effect.sets.held: True -> False",
    "jog_angle.effect.direction: left out",
    "jog_coord.effect.about: axis -> ",
    "state.pins.each: pin -> ",
    "editions/mycobot280.yaml: state.servo_voltages.start: 12 -> 13",
    "get_angles_plan.agrees_with",
    "is_moving.role: moving -> reached",
    "transport.baudrate: 115200 -> 115201",
    "transport.deadline_ms: 500 -> 501",
    "transport.stop_bits: 1 -> 2",
    "quantities.voltage.unit: volt ->",
    "quantities.j5_angle.range: 160 -> 161",
    "quantities.joint.range: 6 -> 5",
    "quantities.limit_angle.scale: 1/10 -> 1",
    "wire.signed_word.signed_at: 33000 -> 33001",
    "value: 254 -> 255",
    "get_digital_input.id: 98 -> 99",
    # Other editions.
    "quantities.j7_angle.range: -165 -> -166",
    "set_break.safety: power -> query",
    "set_hand_gripper_p.request.0.default: 14 -> 15",
    "get_robot_status.deadline_ms: 75000 -> 75001",
    "transport.baudrate: 1000000 -> 1000001",
    "get_monitor_mode.effect.reports: monitoring -> ",
    "error_codes.no_power: 49 -> 50",
    "values.solved_angles.items.j3: solved_angle -> measured_angle",
    "frame.maximum_data: 56 -> 57",
]


@pytest.fixture(scope="module")
def all_tasks() -> list[Task]:
    return list(tasks())


@pytest.mark.parametrize("wanted", SAMPLE)
def test_wrong_fact_is_noticed(all_tasks: list[Task], wanted: str) -> None:
    task = next(task for task in all_tasks if wanted in f" {task.title}")
    assert run(task)[1].killer, task


def test_every_kind_of_fact_has_mutants(all_tasks: list[Task]) -> None:
    assert len(all_tasks) > 15000
    assert {task.edition for task in all_tasks} == {*PATHS} - {"mercury_x1"}  # it is all of the B1
    assert len({task.kind for task in all_tasks}) > 70


def test_spec_as_it_is_is_not_noticed() -> None:
    path = next(files("mycobot280"))
    verdict = judged("mycobot280", path, load(path))
    assert (verdict.killer, verdict.equal) == ("", True)


def test_removed_fact_is_not_in_the_changed_file() -> None:
    path = next(files("mycobot"))
    root = changed(load(path), ("geometry", "links", 0, "offset"), None)
    assert isinstance(root, Mapping)
    assert load(path) != root


def test_few_mutants_may_survive(all_tasks: list[Task]) -> None:
    # The document states the first two; of most other editions one source is known.
    for editions, share in (({"mycobot", "mycobot280"}, 50), ({*PATHS, "servo_bus"}, 10)):
        found = [task for task in all_tasks if task.edition in editions]
        listed = [task for task in found if accepted(task.edition, task.kind, task.title)]
        assert len(listed) < len(found) / share
