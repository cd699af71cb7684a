"""Compare this tree with the last release, and name the version number that must follow.

    make release-check                 # compare with the last release
    make release-check SINCE=HEAD~9    # compare with a revision, as if it were the last release

docs/compatibility.md says what a release promises, in one row for each entry of ``PROMISES``. The
exit code is 1 if this tree's version (Cargo.toml) is too low for the differences.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Set
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import Any

import griffe

from cobotwire import capture
from cobotwire.protocol.errors import CaptureError
from cobotwire.protocol.loading import VERSION, table_of
from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.diff import Finding, bump, bump_before_1_0, diff_all
from cobotwire_codegen.diff.rules import LEVELS, Level
from cobotwire_codegen.diff.sources import read
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.project import spec_files
from release import RECORDED, ROOT, Failed, git, version
from release import VERSION as NUMBER

COMPARED = ("Cargo.toml", "docs", "python", "spec", "tests/capture")
BUMPS = ("major", "minor", "patch", "none")
# Prints the subcommands with their options, and the exit codes.
COMMAND_LINE = """
import click, json
from cobotwire.cli.app import app
from cobotwire.cli.shared.exit_codes import CODES
def words(command, path):
    yield from (f"{path} {word}" for each in command.params for word in each.opts)
    context = click.Context(command)
    # The list leaves out subcommands that cannot run here, such as studio without its JavaScript.
    listed = command.list_commands(context) if isinstance(command, click.Group) else ()
    for name in {*listed, *getattr(command, "subcommands", getattr(command, "verbs", ()))}:
        yield f"{path} {name}"
        yield from words(command.get_command(context, name), f"{path} {name}")
print(json.dumps([*words(app, "cobotwire"), *(f"exit code {n}: {e.__name__}" for e, n in CODES)]))
"""


def promised_names(tree: Path) -> Iterator[str]:
    """Yield the packages that the page promises, and what the API reference describes.

    Raises:
        Failed: the page names no package, so that nothing would be compared.
    """
    page = (tree / "docs/compatibility.md").read_text("utf-8")
    row = re.search(r"^\| \*\*Python API\*\* .*$", page, re.MULTILINE)
    packages = re.findall(r"`(cobotwire[\w.]*)`", row[0] if row else "")
    if not packages:
        raise Failed("docs/compatibility.md has no row 'Python API' that names packages")
    yield from packages
    for path in sorted((tree / "python/cobotwire/editions").glob("[!_]*")):
        yield f"cobotwire.editions.{path.stem}"
    for path in sorted((tree / "docs/api").glob("*.md")):
        yield from re.findall(r"^\.\. auto\w+:: ([\w.]+)", path.read_text("utf-8"), re.MULTILINE)


class _Reexports(griffe.Extension):
    """Let ``from x import y as y`` export ``y``, as type checkers do."""

    def on_alias_instance(self, *, node: Any, alias: griffe.Alias, **_: Any) -> None:
        if isinstance(node, ast.ImportFrom):
            kept = any(alias.name == each.name == each.asname for each in node.names)
            alias.public = kept or None


def _api_of(tree: Path, names: Set[str]) -> griffe.Module:
    """Return a module that has the promised objects of a tree under their full names."""
    found = griffe.load(
        "cobotwire",
        search_paths=[tree / "python"],
        extensions=griffe.Extensions(_Reexports()),
        allow_inspection=False,
        resolve_aliases=True,
    )
    api = griffe.Module("promised")
    api.exports = [*names]
    for module in _modules(found):
        listed = module.parent.exports if module.parent else None
        module.public = module.path in names or module.name in (listed or ())
        for member in module.members.values():
            if isinstance(member, griffe.Alias) and member.wildcard_imported:
                with suppress(griffe.AliasResolutionError):  # of another package
                    member.public = not member.is_module and not member.name.startswith("_")
    for name in names:
        with suppress(KeyError):
            target = found[name.removeprefix("cobotwire.")] if name != "cobotwire" else found
            api.members[name] = griffe.Alias(name, target, parent=api)
    return api


def _modules(module: Any) -> Iterator[griffe.Module]:
    yield module
    for each in module.modules.values():
        if not each.is_alias:
            yield from _modules(each)


def python_api(old: Path, new: Path) -> Iterator[Finding]:
    """Compare names, parameters and defaults. griffe compares no types."""
    names = dict.fromkeys(promised_names(old)).keys()
    before, after = _api_of(old, names), _api_of(new, names)
    if missing := names - before.members.keys():
        raise Failed(f"the last release promises names that it lacks: {sorted(missing)}")
    for broken in griffe.find_breaking_changes(before, after):
        yield _finding("api", broken.kind.name.lower().replace("_", "-"), _place_of(broken))
    # Comparing in the other direction reports additions as removals.
    for added in griffe.find_breaking_changes(after, before):
        if added.kind is griffe.BreakageKind.OBJECT_REMOVED:
            yield _finding("addition", "object-added", _place_of(added))


def _place_of(broken: griffe.Breakage) -> str:
    place = broken.obj.path.removeprefix("promised.")
    parameter = getattr(broken.old_value or broken.new_value, "name", "")
    return f"{place}({parameter})" if "PARAMETER" in broken.kind.name else place


def command_line(old: Path, new: Path) -> Iterator[Finding]:
    """Compare subcommands, options and exit codes."""
    before, after = _words_of(old), _words_of(new)
    yield from (_finding("api", "word-removed", word) for word in sorted(before - after))
    yield from (_finding("addition", "word-added", word) for word in sorted(after - before))


def _words_of(tree: Path) -> set[str]:
    where = {**os.environ, "PYTHONPATH": str(tree / "python"), "COBOTWIRE_CODEC": "reference"}
    command = (sys.executable, "-c", COMMAND_LINE)
    ended = subprocess.run(command, env=where, capture_output=True, text=True, check=False)  # noqa: S603
    if ended.returncode:
        raise Failed(f"the command line of {tree} cannot be listed: {ended.stderr[-200:].strip()}")
    return {*json.loads(ended.stdout)}


def editions(old: Path, new: Path) -> Iterator[Finding]:
    """Compare the specs, as ``cobotwire-gen diff`` does."""
    try:
        yield from diff_all(read(str(old)).editions, read(str(new)).editions)
    except SpecError:
        yield _finding("wire", "not-compared", "spec", "the rows of the spec language say why")


def spec_language(old: Path, new: Path) -> Iterator[Finding]:
    """Check the old specs by the rules of today."""
    del new  # Its rules are those of the modules that are imported.
    for path in spec_files(old):
        try:
            checked_edition(path, old)
        except SpecError as error:
            for problem in error.problems:
                where = str(problem.place).removeprefix(f"{old}/")
                yield _finding("api", f"rejected-by-{problem.code}", where, problem.message)


def json_documents(old: Path, new: Path) -> Iterator[Finding]:
    """Load each old ``edition.json`` as a generated package is loaded."""
    del new
    for path in sorted((old / "python/cobotwire/editions").glob("*/edition.json")):
        document, where = json.loads(path.read_bytes()), path.relative_to(old).as_posix()
        try:
            if document["version"] == VERSION:
                table_of(document)
            else:
                yield _finding("behaviour", "format-changed", where, f"is {VERSION}: build again")
        except (KeyError, TypeError, ValueError) as error:
            yield _finding("api", "not-loaded", where, repr(error))


def captures(old: Path, new: Path) -> Iterator[Finding]:
    """Read the recordings of earlier releases; all must still be there."""
    kept = {path.name: path for path in (new / RECORDED).glob("*.pcapng")}
    for path in sorted((old / RECORDED).glob("*.pcapng")):
        where = f"{RECORDED}/{path.name}"
        if path.name not in kept or kept[path.name].read_bytes() != path.read_bytes():
            yield _finding("api", "recording-removed", where, "recordings of releases stay")
        try:
            if not [*capture.read(path)]:
                yield _finding("api", "recording-empty", where)
        except CaptureError as error:
            yield _finding("api", "recording-rejected", where, str(error))


PROMISES: dict[str, Callable[[Path, Path], Iterator[Finding]]] = {
    "Python API": python_api,
    "command line": command_line,
    "wire": editions,
    "spec language": spec_language,
    "JSON documents": json_documents,
    "captures": captures,
}


def _finding(level: Level, rule: str, where: str, message: str = "") -> Finding:
    return Finding(rule, level, where, "", "", message)


def last_release(tags: Iterable[str], current: str) -> str | None:
    """Return the tag of the highest version below the current one; None without any."""
    tags = [tag for tag in tags if NUMBER.fullmatch(tag[1:]) and _parts(tag) < _parts(current)]
    return max(tags, key=_parts, default=None)


def _parts(number: str) -> tuple[int, ...]:
    # A pre-release promises the same as its release.
    return tuple(map(int, re.findall(r"\d+", number)[:3]))


def raised(old: str, new: str) -> str:
    """Return the part of the version number that was raised: major, minor, patch or none."""
    pairs = zip(BUMPS, _parts(old), _parts(new))
    return next((part for part, before, after in pairs if after != before), "none")


def compare(revision: str) -> bool:
    """Print how this tree differs from a revision; return whether its version is high enough.

    Raises:
        Failed: there is no such revision, or it cannot be compared.
    """
    commit = git("rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    found: dict[str, list[Finding]] = {}
    with tempfile.TemporaryDirectory() as folder:
        old, packed = Path(folder).resolve(), f"{folder}/old.tar"
        git("archive", "--output", packed, commit, "--", *COMPARED)
        shutil.unpack_archive(packed, old, filter="data")
        before = version(old)
        for name, promise in PROMISES.items():
            found[name] = [*dict.fromkeys(promise(old, ROOT))]
            for one in sorted(found[name], key=lambda one: [*LEVELS].index(one.level)):
                if one.level != "docs":
                    print(f"{one.level}: {one.rule}: {one.where}: {one.message}".removesuffix(": "))
    print(f"\nSince {revision} ({before}):")
    for name, differences in found.items():
        counts = Counter(one.level for one in differences)
        words = ", ".join(f"{counts[level]} {level}" for level in LEVELS if counts[level])
        print(f"  {name:16}{words or 'no difference'}")
    needed = (bump if _parts(before)[0] else bump_before_1_0)(chain(*found.values()))
    made = raised(before, version())
    enough = BUMPS.index(made) <= BUMPS.index(needed)
    print(
        f"{'ok  ' if enough else 'FAIL'}  version: {before} to {version()} is a bump of: {made}; "
        f"the differences need: {needed}"
    )
    return enough


def main() -> int:
    """Compare; return 1 if the version number is too low."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("revision", nargs="?", help="by default the tag of the last release")
    tags = git("tag", "--list", "v*").split()
    last = parser.parse_args().revision or last_release(tags, version())
    if last is None:
        print(f"{version()} is the first release: there is no earlier one to compare with")
        return 0
    try:
        return 0 if compare(last) else 1
    except (Failed, SpecError) as error:
        print(f"FAIL  {error}")
        return 1


if __name__ == "__main__":
    sys.exit(main())
