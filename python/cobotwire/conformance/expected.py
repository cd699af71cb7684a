"""Read a file of known failures: each line has a name, or a pattern of names, and a reason.

    decode-values/get_encoder/*   the library reads the number as signed
    reply-fields/get_speed        fixed in firmware 2.1

For a codec, the names are those of questions. For a device and a client they are
``TEST-CASE/COMMAND``, or only the test case if it is about the whole line. The reason is required.
Empty lines, and lines that begin with ``#``, are skipped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase

from cobotwire.conformance.report import Cause, Result, Verdict
from cobotwire.conformance.suite import EXPECTED_FAILURE
from cobotwire.protocol.errors import UsageError


@dataclass(slots=True)
class Expectation:
    """A line of the file.

    ``met`` counts the failures that it matches; ``passed`` has the names of its matches that
    passed.
    """

    pattern: str
    reason: str
    place: str
    met: int = 0
    passed: list[str] = field(default_factory=list)


def read_expectations(text: str, name: str) -> list[Expectation]:
    """Return the lines of a file called ``name``.

    Raises:
        UsageError: a line has no reason, or repeats the name of another line.
    """
    found: dict[str, Expectation] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        pattern, _, reason = line.strip().partition(" ")
        place = f"{name}:{number}"
        if not reason.strip():
            message = (
                f"{place}: {line.strip()} has no reason; write the name, a space and the reason"
            )
            raise UsageError(place, message=message)
        if pattern in found:
            message = f"{place}: {pattern} is already in {found[pattern].place}"
            raise UsageError(place, message=message)
        found[pattern] = Expectation(pattern, reason.strip(), place)
    return list(found.values())


def excuse(expectations: Sequence[Expectation], name: str, *, failed: bool) -> str:
    """Return the reason of a known failure, and count it; empty for anything else."""
    known = next((e for e in expectations if fnmatchcase(name, e.pattern)), None)
    if known is None:
        return ""
    if not failed:
        known.passed.append(name)
        return ""
    known.met += 1
    return f"expected to fail ({known.place}): {known.reason}"


def with_known(expectations: Sequence[Expectation], results: Sequence[Result]) -> list[Result]:
    """Return the results of a run with known failures excused, and a failure for wrong lines."""
    if not expectations:
        return [*results]
    return [*(_excused(expectations, result) for result in results), *outdated(expectations)]


def _excused(expectations: Sequence[Expectation], result: Result) -> Result:
    name = f"{result.case}/{result.command}" if result.command else result.case
    # A test case that was not run may still fail, so a line about it is not wrong.
    reason = excuse(expectations, name, failed=result.verdict is not Verdict.PASS)
    if not reason or result.verdict is not Verdict.FAIL:
        return result
    cause = Cause.NOT_SUPPORTED
    return replace(result, verdict=cause.verdict, cause=cause, reason=reason)


def outdated(expectations: Sequence[Expectation]) -> Iterator[Result]:
    """Yield a failure for each line that is wrong, because it would hide the next failure."""
    for known in expectations:
        if known.passed:
            reason = (
                f"{known.place}: {len(known.passed)} did not fail, among them {known.passed[0]}"
            )
        elif not known.met:
            reason = f"{known.place}: nothing that was tested matches {known.pattern}"
        else:
            continue
        case, place = EXPECTED_FAILURE, known.place
        yield Result(case.id, "", Verdict.FAIL, reason, (), place, group="known failures")
