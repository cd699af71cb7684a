"""A wrong edition fails on a correct arm, and the failure names the field and both values."""

from __future__ import annotations

from cobotwire import editions
from cobotwire.protocol.table import Case, Command, Table, Variant
from conformance.device.testing import bad, prepared

TABLE = editions.load("mycobot280").TABLE


def _ten_times_finer(command: Command, field: str) -> Command:
    def finer(variant: Variant) -> Variant:
        return Variant(
            tuple(
                f._replace(
                    cases=tuple(
                        Case(c.when, tuple(n._replace(divide=n.divide * 10) for n in c.numbers))
                        for c in f.cases
                    ),
                )
                if f.name == field
                else f
                for f in variant.fields
            )
        )

    return command._replace(reply=tuple(map(finer, command.reply)))


def _wrong(name: str, field: str) -> Table:
    return TABLE._replace(
        commands=tuple(_ten_times_finer(c, field) if c.name == name else c for c in TABLE.commands),
    )


def test_wrong_scale_of_a_reply_fails_with_the_field_and_both_values() -> None:
    report = prepared(_wrong("get_joint_min_angle", "angle"), device=TABLE).run()
    [found] = [r for r in bad(report) if (r.case, r.command) == ("read-back", "set_joint_min")]
    assert "angle (degree): set -" in found.reason
    wanted, got = (
        float(word.split()[-1]) for word in found.reason.rsplit(" (", 1)[0].split(":")[1].split(",")
    )
    assert got == wanted / 10


def test_wrong_scale_that_nothing_sets_disagrees_with_another_query() -> None:
    report = prepared(_wrong("get_angles", "angles"), device=TABLE).run()
    found = [r.reason for r in bad(report) if r.case == "agrees" and r.command == "get_encoders"]
    assert "get_angles reports angles.j1 =" in found[0]
    assert "encoders.j1 is" in found[0]
