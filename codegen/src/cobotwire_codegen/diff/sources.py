"""Reads the arguments OLD and NEW: an edition file, a folder with spec/, or a git revision."""

from __future__ import annotations

import io
import subprocess
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from cobotwire_codegen.build import Built, build_edition
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.project import edition_files

SECONDS = 60


class SourceError(ValueError):
    """The argument is not an edition file, a folder with a spec, or a revision with one."""


@dataclass(frozen=True, slots=True)
class Source:
    """Editions by name; ``one`` if the argument was a single file."""

    shown: str
    editions: dict[str, Edition]
    one: bool


def read(given: str) -> Source:
    """Return the editions of a path if it exists, else of a revision.

    The editions are built, not checked: an old version can be compared even if the rules have
    become stricter since.

    Raises:
        SourceError: no path and no revision has that name, or it has no spec.
        SpecError: it cannot be built.
    """
    path = Path(given)
    if path.is_file():
        edition = build_edition(path, Path.cwd())
        return Source(given, {edition.name: edition}, one=True)
    if path.is_dir():
        if not (path / "spec" / "editions").is_dir():
            raise SourceError(f"the folder {given} contains no spec/editions")
        return Source(given, _editions(path, Path.cwd()), one=False)
    with _checked_out(given) as folder, _places_in(given):
        return Source(given, _editions(folder, folder), one=False)


def paired(old: Source, new: Source) -> tuple[dict[str, Edition], dict[str, Edition]]:
    """Return the editions to compare: a single file is compared with the edition of its name.

    Raises:
        SourceError: the other source has no edition of that name.
    """
    if old.one == new.one:
        return old.editions, new.editions
    single, many = (old, new) if old.one else (new, old)
    [name] = single.editions
    if name not in many.editions:
        raise SourceError(f"there is no edition {name} in {many.shown}")
    found = {name: many.editions[name]}
    return (old.editions, found) if old.one else (found, new.editions)


def _editions(folder: Path, root: Path) -> dict[str, Edition]:
    built: Built = {}
    found = [build_edition(path, root, built=built) for path in edition_files(folder)]
    return {edition.name: edition for edition in found}


@contextmanager
def _checked_out(revision: str) -> Iterator[Path]:
    """Extract the spec of a revision into a temporary folder."""
    missing = f"{revision} is not a file, a folder or a git revision"
    # Only the commit's hash is passed on: a revision's name could look like an option.
    words = ("rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    commit = _git(*words, failed=missing).decode().strip()
    tar = _git("archive", commit, "spec", failed=f"the revision {revision} holds no spec/ here")
    with tempfile.TemporaryDirectory(prefix="cobotwire-diff-") as folder:
        with tarfile.open(fileobj=io.BytesIO(tar)) as archive:
            # tarfile has the filter since 3.11.4; before that, git's own archive is trusted.
            if hasattr(tarfile, "data_filter"):
                archive.extraction_filter = tarfile.data_filter
            archive.extractall(folder)  # noqa: S202  (made by git just now)
        yield Path(folder)


def _git(*words: str, failed: str) -> bytes:
    command = ["git", *words]
    try:
        # No shell; every word is fixed but the revision, which cannot be read as an option.
        done = subprocess.run(command, capture_output=True, check=False, timeout=SECONDS)  # noqa: S603
    except FileNotFoundError:
        raise SourceError(f"{failed}: git is not installed") from None
    except subprocess.TimeoutExpired:
        raise SourceError(f"{failed}: git took longer than {SECONDS} s") from None
    if done.returncode != 0:
        reason = done.stderr.decode(errors="replace").strip().partition("\n")[0]
        raise SourceError(f"{failed} ({reason})" if reason else failed)
    return done.stdout


@contextmanager
def _places_in(revision: str) -> Iterator[None]:
    """Prefix the file name of every problem with the revision, as git does."""
    try:
        yield
    except SpecError as error:
        raise SpecError(
            replace(problem, place=replace(place, file=f"{revision}:{place.file}"))
            for problem in error.problems
            for place in (problem.place,)
        ) from error
