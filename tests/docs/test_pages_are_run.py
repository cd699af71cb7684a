"""Each command of README and website has a plan by which `make wheels-check` runs it."""

from __future__ import annotations

import pytest

from newcomer.run_pages import pages
from newcomer.website.blocks import blocks, commands, programs
from newcomer.website.planned import Expected, NotRun, Plan, Program, unplanned
from newcomer.website.plans.every import PLANS
from vectors import ROOT


@pytest.mark.parametrize("page", pages())
def test_every_command_has_a_plan_or_a_reason(page: str) -> None:
    assert unplanned((ROOT / page).read_text(encoding="utf-8"), PLANS.get(page, Plan())) == []


def test_every_plan_names_an_existing_page() -> None:
    assert set(PLANS) <= set(pages())
    assert len(pages()) > 40


PAGE = """\
# Page

    cobotwire sim     # simulate an arm
    cobotwire plot arm.pcapng \\
        -o arm.svg

A frame:

    FE FE 02 20 FA

```sh
pip install cobotwire  # first
```
```python
print(1)
```
```text
1
```
<!-- file: a.py -->
```python
print(2)
```
"""


def test_commands_and_programs_of_a_page_are_found() -> None:
    found = ["cobotwire sim", "cobotwire plot arm.pcapng -o arm.svg", "pip install cobotwire"]
    assert list(commands(PAGE)) == found
    [program] = programs(PAGE)
    assert (program.text, program.shown) == ("print(1)\n", "1\n")
    assert [block.kind for block in blocks(PAGE)] == ["indented"] * 2 + ["sh", "python", "python"]
    plan = Plan({found[0]: Expected(), found[1]: NotRun("no plots"), "ls": Expected()})
    plan = plan._replace(programs={"print(3)": Program()})
    problems = [f"no plan: {found[2]}", "not on the page: ls", "not on the page: print(3)"]
    assert unplanned(PAGE, plan) == problems
