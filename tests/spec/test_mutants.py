"""A wrong fact in the spec is noticed: a sample of what ``make spec-mutants`` changes."""

from __future__ import annotations

import os
from collections import Counter

import pytest

from cobotwire_codegen.load import load
from spec_mutants.campaign import Task, accepted, run, run_all, tasks
from spec_mutants.spec_files import PATHS, files, verdict_on

# One mutant for each statement and each edition. For the checks of the generator,
# tests/codegen/bad_specs.yaml has a bad spec each.
SAMPLE = {
    "mycobot": (
        "commands/power.yaml: commands.power_on.effect.sets.held: True -> False",
        "wire.signed_word.signed_at: 33000 -> 33001",
    ),
    "mycobot280": (
        "editions/mycobot280.yaml: state.servo_voltages.start: 12 -> 13",
        "get_angles_plan.agrees_with",
        "quantities.j5_angle.range: 160 -> 161",
    ),
    "mycobot280_rdkx5": ("quantities.servo_current.unit: milliampere -> ",),
    "mycobot320": (
        "set_hand_gripper_p.request.0.default: 14 -> 15",
        "get_robot_status.deadline_ms: 75000 -> 75001",
        "set.effect.cases.OPEN.to: 100 -> 101",
    ),
    "mecharm270": ("changes.12.set.range: 544 -> 545",),
    "myarm300": ("state.pins.each: pin -> ",),
    "myarm_c650": ("transport.baudrate: 1000000 -> 1000001", "value: 254 -> 255"),
    "myarm_m750": ("stop_robot.effect.does: stop -> halt",),
    "mybuddy": ("values.target_coords.items.z: height -> reference_length",),
    "mypalletizer260": ("changes.11.request.0.set.cases.2.type: j2_angle -> angle",),
    "mercury_a1": (
        "jog_rpy.safety: motion -> setting",
        "is_moving.role: moving -> reached",
        "get_monitor_mode.effect.reports: monitoring -> ",
        "error_codes.no_power: 49 -> 50",
        "error_codes.stopped: left out",
        "acks.fields.0.const: left out",
        "quantities.dynamic_parameter.range: 62 -> 63",
        "state.run_errors.type: motor_error -> finger_angle",
        "state.encoder_errors.each: joint -> ",
        "get_hand_gripper.request.2.default: 0 -> 1",
        "values.solved_angles.items.j3: solved_angle -> measured_angle",
        "frame.maximum_data: 56 -> 57",
        "get_digital_input.id: 98 -> 99",
    ),
    "mercury_b1": ("quantities.j12_step_angle.range: 315 -> 314",),
    "pro400": ("common/six_joints.yaml: changes.1.set.choices: 6 -> 7",),
    "pro450": ("set_color.effect.stores: red: red -> green",),
    "pro630": ("editions/pro630/changes.yaml: changes.18: left out",),
    "servo_bus": ("joints: 1 -> 2",),
}


@pytest.fixture(scope="module")
def all_tasks() -> list[Task]:
    return list(tasks())


@pytest.mark.parametrize(
    ("edition", "wanted"), [(name, each) for name, texts in SAMPLE.items() for each in texts]
)
def test_wrong_fact_is_noticed(all_tasks: list[Task], edition: str, wanted: str) -> None:
    task = next(task for task in all_tasks if task.edition == edition and wanted in task.title)
    assert run(task).killer, task


if "SPEC_MUTANTS" in os.environ:  # `make spec-mutants`: every N-th mutant of all

    def test_every_wrong_fact_is_noticed_or_has_no_second_source(all_tasks: list[Task]) -> None:
        chosen = all_tasks[:: int(os.environ["SPEC_MUTANTS"])]
        counts: dict[str, Counter[str]] = {name: Counter() for name in SAMPLE}
        for task, verdict in zip(chosen, run_all(chosen)):
            reason = accepted(task.edition, task.kind, task.title)
            what = "equal" if verdict.equal else "killed" if verdict.killer else "listed"
            counts[task.edition][what if what != "listed" or reason else "missed"] += 1
            if what == "listed":
                print(f"survives  {task.kind}  {task.title}: {reason or 'WITHOUT A REASON'}")
        for edition, found in counts.items():
            print(f"{edition:17} {dict(found)}")
            assert found["missed"] <= (found["killed"] + found["missed"]) / 50, edition


def test_every_kind_of_fact_has_mutants(all_tasks: list[Task]) -> None:
    assert len(all_tasks) > 15000
    # The Mercury X1 has no facts of its own: it is the same as the B1.
    assert {task.edition for task in all_tasks} == {*SAMPLE} == {*PATHS} - {"mercury_x1"}
    assert len({task.kind for task in all_tasks}) > 70


def test_unchanged_spec_is_not_noticed() -> None:
    path = next(files("pro450"))
    verdict = verdict_on("pro450", path, load(path))
    assert (verdict.killer, verdict.equal) == ("", True)


def test_few_mutants_may_survive(all_tasks: list[Task]) -> None:
    # The document states the first two; of most other editions one source is known.
    for editions, share in (({"mycobot", "mycobot280"}, 50), ({*PATHS, "servo_bus"}, 10)):
        found = [task for task in all_tasks if task.edition in editions]
        listed = [task for task in found if accepted(task.edition, task.kind, task.title)]
        assert len(listed) < len(found) / share
