"""Package the crates, unpack them in a clean folder, and use them there as a user would.

The program of the README runs against ``cobotwire sim``. A program with the generated module of a
protocol that has hostile texts compiles. Every feature compiles alone, and all together; the
documentation has no warning. If something fails, this script prints it, and exits with 1.
"""

# ruff: noqa: S603  (cargo and our own programs are started)

from __future__ import annotations

import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
CRATES = {"simd": "cobotwire-simd", "core": "cobotwire-core", "table": "cobotwire-table"}
FEATURES = ("", "serial", "tokio", "mycobot280", "mycobot280,serial", "serial,tokio")
# Texts that try to leave a comment, an attribute, a link or a block of code.
HOSTILE = r"*/ `ended` <b>[link] \"#]} {{ ``` \u{0} https://x.y"


def patches(folder: Path) -> list[str]:
    """Return options by which cargo finds our crates in a folder, not on crates.io."""
    return [f'--config=patch.crates-io.{name}.path="{folder / at}"' for at, name in CRATES.items()]


def run(folder: Path, *words: str) -> str:
    """Run a command and return its output; it must not fail."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(words)} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def unpacked(folder: Path) -> Path:
    """Package the crates of this project, and unpack them; return their folder."""
    crates = folder / "crates"
    for at, name in {**CRATES, "client": "cobotwire"}.items():
        made = str(folder / "made")
        options = ("--no-verify", "--allow-dirty", "--quiet", "--target-dir", made)
        run(ROOT, "cargo", "package", *options, *patches(ROOT / "rust"), "--package", name)
        [archive] = (folder / "made/package").glob(f"{name}-[0-9]*.crate")
        with tarfile.open(archive) as packed:
            packed.extractall(folder, filter="data")
        crates.mkdir(exist_ok=True)
        (folder / archive.stem).rename(crates / at)
    return crates


def new_program(folder: Path, crates: Path, name: str, text: str) -> Path:
    """Return the folder of a new program that depends on the unpacked crate."""
    at = folder / name
    (at / "src").mkdir(parents=True)
    (at / "src/main.rs").write_text(text)
    depends = (
        f'[dependencies]\ncobotwire = {{ path = "{crates}/client", features = ["mycobot280"] }}\n'
    )
    package = f'[package]\nname = "{name}"\nversion = "0.0.0"\nedition = "2024"\n'
    (at / "Cargo.toml").write_text(f"{package}{depends}[workspace]\n")
    return at


def first_program(folder: Path, crates: Path, target: str) -> None:
    """Run the program of the README against a simulated arm."""
    block = re.search(
        r"<!-- file: main.rs -->\n```rust\n(.*?)```", (ROOT / "README.md").read_text(), re.S
    )
    assert block is not None, "the README has the program"
    program = new_program(folder, crates, "first", block[1])
    run(program, "cargo", "build", "--quiet", *patches(crates), target)
    words = ("cobotwire", "sim", "--tcp", "127.0.0.1:0", "--quiet")
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as arm:
        assert arm.stdout is not None
        url = arm.stdout.readline().split()[0]
        shown = run(program, f"{target.partition('=')[2]}/debug/first", url)
        arm.terminate()
    print(f"the first program prints {shown.strip()}")


def own_protocol(folder: Path, crates: Path, target: str) -> None:
    """Compile the module of a protocol with texts that try to leave their comments."""
    lamp = (ROOT / "tests/codegen/lamp.yaml").read_text()
    # Docs inside braces share a line with other keys; those on lines of their own are enough.
    doc = re.compile(r"^( *doc: )[^{}\n]*$", re.M)
    (folder / "lamp.yaml").write_text(doc.sub(lambda found: f"{found[1]}'{HOSTILE}'", lamp))
    text = 'mod lamp;\nfn main() {\n    println!("{:?}", lamp::edition().is_ok());\n}\n'
    program = new_program(folder, crates, "own", text)
    words = ("--out", "lamp", "--rust", "own/src/lamp")
    run(folder, "cobotwire-gen", "build", "lamp.yaml", *words)
    (program / "src/lamp/mod.rs").write_text("mod lamp;\npub use lamp::*;\n")
    shown = run(program, "cargo", "run", "--quiet", *patches(crates), target)
    assert shown == "true\n", shown


def main() -> None:
    """Package, and use the packages."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        crates = unpacked(folder)
        target = f"--target-dir={folder / 'target'}"
        first_program(folder, crates, target)
        own_protocol(folder, crates, target)
    for features in FEATURES:
        run(ROOT, "cargo", "check", "--quiet", "--package", "cobotwire", "--features", features)
    run(ROOT, "cargo", "test", "--quiet", "--package", "cobotwire", "--all-features", "--tests")
    document = ("cargo", "rustdoc", "--quiet", "--package", "cobotwire", "--all-features")
    run(ROOT, *document, "--", "--deny", "warnings")


if __name__ == "__main__":
    main()
