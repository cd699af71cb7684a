"""Fetch third-party JavaScript: the plotting library of the studio, and a checker for its tests.

    python tools/front_end.py          fetch what is missing
    python tools/front_end.py --check  exit with 1 if something is missing or differs

Both come from the npm registry, in pinned versions with their checksums. Third-party code is not
committed. Wheels ship the plotting library, with its licence. Set NPM_CONFIG_REGISTRY to use a
mirror.
"""

from __future__ import annotations

import base64
import hashlib
import io
import os
import sys
import tarfile
import urllib.request
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
REGISTRY = "https://registry.npmjs.org/"
SECONDS = 60


class Package(NamedTuple):
    """A package of the npm registry.

    Attributes:
        name, version: the package.
        sha512: the checksum of its archive, in base64, as the registry states it.
        files: the files to keep: the path in the archive, and the path here.
    """

    name: str
    version: str
    sha512: str
    files: tuple[tuple[str, str], ...]

    @property
    def stamp(self) -> Path:
        """The file that says which version was fetched."""
        folder = (ROOT / self.files[0][1]).parent
        return folder / f"{self.name}.version"

    @property
    def shipped(self) -> bool:
        """Whether wheels of cobotwire ship this package; if not, only tests use it."""
        return self.files[0][1].startswith(PAGE)

    @property
    def present(self) -> bool:
        """Whether this version is here."""
        files = all((ROOT / path).is_file() for _, path in self.files)
        return files and self.stamp.is_file() and self.stamp.read_text() == f"{self.version}\n"


PAGE = "python/cobotwire/studio/page/vendor"
PACKAGES = (
    Package(
        "uplot",
        "1.6.32",
        "KIMVnG68zvu5XXUbC4LQEPnhwOxBuLyW1AHtpm6IKTXImkbLgkMy+jabjLgSLMasNuGGzQm/ep3tOkyTxpiQIw==",
        (
            ("package/dist/uPlot.iife.min.js", f"{PAGE}/uPlot.iife.min.js"),
            ("package/dist/uPlot.min.css", f"{PAGE}/uPlot.min.css"),
            ("package/LICENSE", f"{PAGE}/LICENSE-uPlot"),
        ),
    ),
    Package(
        "axe-core",
        "4.14.1",
        "FHfa+lmNjQZfJz1q8wKqIDwC6DExcHt/pkjNQb09a3NPjCKg2rhu5qb2S4r76ASyFNNtuFooJpZe37OgudVGtQ==",
        (("package/axe.min.js", "target/front-end/axe.min.js"),),
    ),
)


def fetch(package: Package) -> None:
    """Write the files of a package.

    Raises:
        SystemExit: the registry cannot be reached, or the archive is not the pinned one.
    """
    registry = os.environ.get("NPM_CONFIG_REGISTRY")
    base = (registry or REGISTRY).rstrip("/")
    url = f"{base}/{package.name}/-/{package.name}-{package.version}.tgz"
    try:
        with urllib.request.urlopen(url, timeout=SECONDS) as answer:  # noqa: S310  (https)
            data = answer.read()
    except (OSError, ValueError) as error:
        sys.exit(f"{url} cannot be fetched: {error}; NPM_CONFIG_REGISTRY names another registry")
    found = base64.b64encode(hashlib.sha512(data).digest()).decode()
    if found != package.sha512:
        sys.exit(f"{url} is not the archive that is pinned in tools/front_end.py: sha512 {found}")
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        for inside, path in package.files:
            file = archive.extractfile(inside)
            assert file is not None, f"{inside} is a file of {package.name}"
            (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
            (ROOT / path).write_bytes(file.read())
    package.stamp.write_text(f"{package.version}\n")


def main() -> None:
    """Fetch the packages that are missing, or report them."""
    missing = [package for package in PACKAGES if not package.present]
    if "--check" in sys.argv[1:]:
        for package in missing:
            print(f"{package.name} {package.version} is missing: run `make front-end`")
        sys.exit(bool(missing))
    for package in missing:
        fetch(package)


if __name__ == "__main__":
    main()
