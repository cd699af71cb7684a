"""Build the npm package, and use it in a clean folder as a user would.

    python tools/npm_package.py            # build, pack, install, run programs; print the sizes
    python tools/npm_package.py --build    # only build it, and the module of the decoder page

The program of the docs runs against ``cobotwire sim``. A module for a protocol with hostile texts
is type-checked and loaded. If something fails, this script prints it, and exits with 1.
"""

# ruff: noqa: S603  (node, npm, cargo and our own programs are started)

from __future__ import annotations

import base64
import fcntl
import gzip
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path, PurePosixPath

from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.project import TYPESCRIPT_EDITIONS, editions, products
from cobotwire_codegen.targets.typescript import literal
from rust_package import HOSTILE

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "clients/typescript"
DECODER = ROOT / "docs/_static/decoder"
TARGET = "wasm32-unknown-unknown"
# What a page loads, compressed.
LARGEST = 220_000
WASM = "dist/cobotwire.wasm"
# What the package is made of.
SOURCES = (
    *("spec/**/*.yaml", "codegen/src/**/*.py", "codegen/src/**/*.j2", "clients/typescript/src/*"),
    *("clients/typescript/*.json", "rust/*/src/**/*.rs", "rust/*/*.json"),
    *("rust/*/Cargo.toml", "Cargo.*"),
)


def run(folder: Path, *words: str) -> str:
    """Run a command and return its output; it must not fail."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(words)} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


@cache
def missing() -> str:
    """Return which tool of the build is not installed, and how to install it; empty if all are."""
    for tool in ("node", "npm", "cargo"):
        if not shutil.which(tool):
            return f"needs {tool}: not installed"
    words = ("rustc", "--print", "target-libdir", "--target", TARGET)
    if not Path(run(ROOT, *words).strip()).exists():
        return f"needs {TARGET}: rustup target add {TARGET}"
    return ""


def build(found: Callable[[], list[Edition]] = lambda: editions(ROOT)) -> Path:
    """Write what the package contains: editions, compiled sources, the session in WebAssembly.

    Return its folder. Do nothing if no source has changed. ``found`` returns the checked editions;
    loading them takes seconds.
    """
    with (PACKAGE / "package.json").open() as lock:
        # Tests in several processes build it.
        fcntl.flock(lock, fcntl.LOCK_EX)
        if _fresh():
            return PACKAGE
        began = time.time()
        for made in products(ROOT, found(), [TYPESCRIPT_EDITIONS]):
            write(made)
        if not (PACKAGE / "node_modules/.bin/tsc").exists():
            run(PACKAGE, "npm", "ci", "--no-audit", "--no-fund")
        index = PACKAGE / "dist/index.js"
        changed = max(path.stat().st_mtime for path in (PACKAGE / "src").iterdir())
        if not index.exists() or index.stat().st_mtime < changed:
            run(PACKAGE, "npm", "run", "--silent", "build")
        words = ("--quiet", "--profile", "wasm", "--target", TARGET)
        run(ROOT, "cargo", "build", "--package", "cobotwire-wasm", *words)
        target = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
        # Replaced as a whole, since other processes may load it.
        shutil.copy(target / TARGET / "wasm/cobotwire_wasm.wasm", PACKAGE / "dist/new.wasm")
        (PACKAGE / "dist/new.wasm").replace(PACKAGE / WASM)
        write(Target(DECODER, {PurePosixPath("module.js"): decoder_module()}, alone=False))
        os.utime(DECODER / "module.js", (began, began))
    return PACKAGE


def _fresh() -> bool:
    """Return whether the package was built after its sources were changed."""
    built = (PACKAGE / WASM, PACKAGE / "editions/mycobot.js", last := DECODER / "module.js")
    sources = (path for pattern in SOURCES for path in ROOT.glob(pattern))
    return all(path.exists() for path in built) and all(
        path.stat().st_mtime < last.stat().st_mtime for path in sources
    )


def decoder_module() -> str:
    """Return the script that gives the decoder page the source of its worker.

    The page also works as a file, and a file may load neither modules nor other files into a
    worker. So the source has the package's modules one after another, and the bytes of the session.
    """
    lines: list[str] = []
    for name in ("errors", "machine", "decoder"):
        text = (PACKAGE / f"dist/{name}.js").read_text("utf-8")
        kept = (line for line in text.splitlines() if not line.startswith(("import ", "//#")))
        lines += (line.removeprefix("export ") for line in kept)
    bytes64 = base64.b64encode((PACKAGE / WASM).read_bytes()).decode()
    lines.append(
        f'const wasm = async () => Uint8Array.from(atob("{bytes64}"), (c) => c.charCodeAt());'
    )
    return f"cobotwire.module = {literal(chr(10).join(lines))};\n"


def loaded() -> int:
    """Return how many bytes a page loads for one edition, compressed."""
    files = [PACKAGE / "editions/mycobot280.js", *(PACKAGE / "dist").glob("*.js")]
    files = [path for path in files if path.name != "node.js"]
    return sum(len(gzip.compress(path.read_bytes(), 9)) for path in (*files, PACKAGE / WASM))


def new_folder(folder: Path) -> None:
    """Pack the package, and install it in a folder as npm does."""
    run(PACKAGE, "npm", "pack", "--silent", "--pack-destination", str(folder))
    [archive] = folder.glob("cobotwire-*.tgz")
    (folder / "package.json").write_text('{"type": "module"}')
    run(folder, "npm", "install", "--no-audit", "--no-fund", "--offline", archive.name)


def program(name: str) -> str:
    """Return a program of the docs."""
    page = (ROOT / "docs/typescript.md").read_text("utf-8")
    block = re.search(rf"<!-- file: {name} -->\n```js\n(.*?)```", page, re.DOTALL)
    assert block is not None, name
    return block[1]


def first_program(folder: Path) -> str:
    """Run the program of the docs against a simulated arm, and return what it prints."""
    (folder / "first.mjs").write_text(program("first.mjs"))
    words = ("cobotwire", "sim", "--tcp", "127.0.0.1:0", "--quiet")
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as arm:
        assert arm.stdout is not None
        url = arm.stdout.readline().split()[0]
        shown = run(folder, "node", "first.mjs", url)
        arm.terminate()
    return shown


def own_protocol(folder: Path) -> str:
    """Check and load the module of a protocol with texts that try to leave their comments."""
    lamp = (ROOT / "tests/codegen/lamp.yaml").read_text()
    # Docs inside braces share a line with other keys; those on lines of their own are enough.
    doc = re.compile(r"^( *doc: )[^{}\n]*$", re.M)
    (folder / "lamp.yaml").write_text(doc.sub(lambda found: f"{found[1]}'{HOSTILE}'", lamp))
    words = ("build", "lamp.yaml", "--out", "lamp", "--typescript", "own")
    run(folder, "cobotwire-gen", *words)
    (folder / "own.mts").write_text(
        'import { Lamp } from "./own/lamp.js";\n'
        'Lamp.open("socket://127.0.0.1:1").catch((error: Error) => console.log(error.name));\n'
    )
    options = ("--module", "nodenext", "--target", "es2022", "--strict", "own.mts")
    run(folder, str(PACKAGE / "node_modules/.bin/tsc"), *options)
    return run(folder, "node", "own.mjs")


def main() -> None:
    """Build the package, and use it."""
    if why := missing():
        sys.exit(why)
    build()
    if "--build" in sys.argv:
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        new_folder(folder)
        print(f"the first program prints {first_program(folder).strip()}")
        shown = own_protocol(folder)
        assert shown == "LinkError\n", shown
    size = loaded()
    print(f"a page loads {size} bytes for one edition, compressed; at most {LARGEST}")
    assert size <= LARGEST


if __name__ == "__main__":
    main()
