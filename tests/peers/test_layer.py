"""Our classes with the maker's names, compared with the maker's classes."""

from __future__ import annotations

import inspect
from functools import lru_cache
from typing import Any

import pytest

import cobotwire.pymycobot as ours
from cobotwire_codegen.library import build_library
from cobotwire_codegen.project import editions
from layer_comparison import compare
from layer_rulings import FRAMES, PARAMETERS, RESULTS, UNANSWERED
from pymycobot_classes import library
from robots.classes import ROBOTS
from vectors import ROOT

CLASSES = [name for name in ours.__all__ if name in ours._MODULES]
# Of each method, one of so many calls.
STRIDE = 5


def _parameters(method: Any) -> list[tuple[str, Any]]:
    return [
        (each.name, each.default)
        for each in inspect.signature(method).parameters.values()
        if each.kind is not each.KEYWORD_ONLY
    ]


def _public(kind: type) -> set[str]:
    return {name for name in dir(kind) if not name.startswith("_")}


@pytest.mark.parametrize("name", CLASSES)
def test_class_has_the_methods_and_parameters_of_the_makers(name: str) -> None:
    theirs, mine = library(name), getattr(ours, name)
    absent = _public(theirs) - _public(mine)
    assert absent <= absences()
    assert _public(mine) - _public(theirs) <= {
        "NATIVE",
        "close",
        "open",
        "go_home",
        "gpio_init",
        "gpio_output",
    }
    shared = (_public(theirs) & _public(mine)) | {"__init__"}
    different = {
        each: (_parameters(getattr(theirs, each)), _parameters(getattr(mine, each)))
        for each in shared
        if _parameters(getattr(theirs, each)) != _parameters(getattr(mine, each))
        and (name, each) not in PARAMETERS
    }
    assert different == {}


@lru_cache
def absences() -> set[str]:
    """Return the names that no class of ours has; each has a reason."""
    library = build_library(ROOT / "spec" / "pymycobot.yaml", ROOT, editions(ROOT))
    assert all(why for _, why in library.absent)
    return {name for name, _ in library.absent}


# It reads the language of the system in a way that Python deprecates.
@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
@pytest.mark.parametrize("name", [name for name in CLASSES if name in ROBOTS])
def test_frames_and_results_equal_those_of_the_makers_class(name: str) -> None:
    found = compare(ROBOTS[name], STRIDE)
    assert found.open == []
    assert found.equal >= 50
    assert found.needed <= {*FRAMES, *(method for _, method in (*RESULTS, *UNANSWERED))}
