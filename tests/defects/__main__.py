"""Test independent subjects with planted defects; print what is found, and whether it is named.

make defects                              run all
make defects DEFECTS='arm firmware'       run some subjects
PYTHONPATH=tests python -m defects arm --only two-joints-swapped --messages
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from fnmatch import fnmatch

from defects.key import SUBJECTS, Defect, defects
from defects.listing import figures, line
from defects.running import CORRECT, report_on
from defects.verdicts import DefectVerdict, Message, messages_of, verdict_on


def main() -> int:
    """Run the subjects; return 1 if a defect is missed, or a correct subject does not conform."""
    given = _arguments()
    began = time.monotonic()
    planted = [d for d in defects(*given.subjects) if fnmatch(d.switch, given.only)]
    subjects = dict.fromkeys(defect.subject for defect in planted)
    right = [(subject, line) for subject in subjects for line in CORRECT.get(subject, ())]
    with ProcessPoolExecutor(given.processes) as pool:
        correct: dict[str, list[Message]] = {}
        for (subject, _), messages in zip(right, pool.map(_correct, right)):
            correct.setdefault(subject, []).extend(messages)
        verdicts = []
        for verdict in pool.map(_verdict_on, planted):
            verdicts.append(verdict)
            print(line(verdict), flush=True)
            if given.messages:
                print(*(f"       {message}" for message in verdict.messages), sep="\n")
    for subject, failures in correct.items():
        for message in failures:
            print(f"REJECTED correct {subject}: {message}")
    print(*figures(verdicts, correct), f"{time.monotonic() - began:.0f} s", sep="\n")
    sound = all(each.found for each in verdicts) and not any(correct.values())
    return 0 if sound else 1


def _correct(run: tuple[str, str]) -> list[Message]:
    subject, line = run
    return messages_of(report_on(subject, "", line))


def _verdict_on(defect: Defect) -> DefectVerdict:
    return verdict_on(defect, messages_of(report_on(defect.subject, defect.switch, defect.line)))


def _arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("subjects", nargs="*", choices=[*SUBJECTS, []], help="default: all")
    parser.add_argument("--only", default="*", help="a pattern of the switches")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--messages", action="store_true", help="print every message")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main())
