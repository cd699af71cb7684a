"""Attack the clients with a hostile peer; print the outcomes of the calls, a row for each profile.

PYTHONPATH=tests python -m attack                           every profile, 180 s
PYTHONPATH=tests python -m attack --profile late --seed 7   one profile, from seed 7 on
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

from attack.profiles import NODE_PROFILES, PROFILES, RUST_PROFILES
from attack.running import campaign
from attack.tally import Tally, markdown, text, total

ROOT = Path(__file__).parent.parent.parent
KNOWN = {"python": PROFILES, "rust": RUST_PROFILES, "node": NODE_PROFILES}


def main() -> int:
    """Run the campaign and print its table; return 1 if something forbidden happened."""
    given = _arguments()
    known = KNOWN[given.client]
    if given.client == "node":
        subprocess.run([sys.executable, ROOT / "tools/npm_package.py", "--build"], check=True)
    profiles = [known[name] for name in given.profile or known if name in known]
    tallies = {profile.name: Tally(profile.name) for profile in profiles}
    began = time.monotonic()
    runs = 0
    for tally in campaign(profiles, given.seed, given.seconds, given.processes):
        runs += 1
        tallies[tally.profile].add(tally)
        for failure in tally.failures:
            print(f"FAILED {failure}\n", file=sys.stderr, flush=True)
    found = [tally for tally in tallies.values() if tally.counts["calls"]]
    seconds = time.monotonic() - began
    summary = f"{runs} runs from seed {given.seed} in {seconds:.0f} s"
    print(text(found))
    print(f"limits: {dict(sorted(total(found).limits.items()))}")
    print(summary)
    if given.markdown:
        _write(given.markdown, given.client, markdown(found) + f"\n{summary}.\n")
    return 1 if any(tally.forbidden for tally in found) else 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="attack", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--profile", action="append", choices=list(PROFILES))
    parser.add_argument("--client", choices=list(KNOWN), default="python")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first run (default: 1)")
    parser.add_argument("--seconds", type=float, default=180.0, help="start no run after this time")
    parser.add_argument("--processes", type=int, default=4)
    parser.add_argument("--markdown", type=Path, help="write the table into this page")
    return parser.parse_args()


BEGIN = {
    "python": "<!-- begin: make attack -->",
    "rust": "<!-- begin: make attack CLIENT=rust -->",
    "node": "<!-- begin: make attack CLIENT=node -->",
}
END = "<!-- end -->"


def _write(page: Path, client: str, table: str) -> None:
    """Replace the table of a page, between its marks."""
    before, begin, rest = page.read_text().partition(BEGIN[client])
    after = rest.partition(END)[2]
    page.write_text(f"{before}{begin}\n\n{table}\n{END}{after}")


if __name__ == "__main__":
    sys.exit(main())
