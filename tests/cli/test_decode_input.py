"""Check the input of ``cobotwire decode``: hex arguments, files and pipes; raw or hex text."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from decoding import FIELD, capture_in, run
from diagnosing import ANGLES, READ


@pytest.fixture
def capture(tmp_path: Path) -> str:
    return capture_in(tmp_path)


@pytest.mark.parametrize("variant", [["--raw"], []])
def test_standard_input_is_decoded_like_a_file(capture: str, variant: list[str]) -> None:
    assert run("-", *variant, stdin=FIELD) == run(capture, *variant)


@pytest.mark.parametrize(
    "text",
    [
        FIELD.hex(),
        FIELD.hex(" ").upper(),
        FIELD.hex("\n"),
        ", ".join(f"0x{byte:02X}" for byte in FIELD),
        "".join(f"0x{byte:02x}" for byte in FIELD),
    ],
)
def test_hex_text_is_decoded_like_raw_bytes(tmp_path: Path, capture: str, text: str) -> None:
    path = tmp_path / "capture.hex"
    path.write_text(text)
    detected, forced = run(str(path)), run(str(path), "--hex")
    assert detected[:2] == forced[:2] == run(capture)[:2]
    assert "as hex text" in detected[2]
    assert forced[2] == ""


def test_long_hex_text_is_decoded_block_by_block(tmp_path: Path) -> None:
    path = tmp_path / "long.hex"
    data = (ANGLES + READ) * 8000
    path.write_text(" 0x".join(["", *(f"{byte:02x}" for byte in data)]))
    _, out, _ = run(str(path), "--quiet", "--summary", "--json")
    assert json.loads(out)["bytes"] == len(data)
    assert json.loads(out)["frames"] == {"0x20 get_angles": 8000}


@pytest.mark.parametrize(
    ("content", "words", "message"),
    [
        (b"12:30:01 RX fe fe 02 20 fa\n", [], "is text, but not hex"),
        (b"fe fe 02 20 f", [], "is not a pair of hex digits"),
        (b"fe fe 02 20 fa zz", ["--hex"], "byte 15 of"),
        (FIELD, ["--hex"], "byte 0 of"),
        (b"fe " * 400 + b"xx", [], "byte 1200 of"),
        ("fe fe 02 20 fa".encode("utf-16"), [], "Unicode"),
    ],
)
def test_text_that_is_not_plain_hex_is_rejected(
    tmp_path: Path, content: bytes, words: list[str], message: str
) -> None:
    path = tmp_path / "odd"
    path.write_bytes(content)
    code, out, err = run(str(path), *words, "--summary")
    assert (code, out) == (2, "")
    assert message in err
    assert run(str(path), "--raw")[0] in (0, 1)


def test_argument_that_is_hex_and_a_file_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "FEFE0220FA").write_bytes(ANGLES)
    code, _, err = run("FEFE0220FA", cwd=tmp_path)
    assert code == 2
    assert "./FEFE0220FA for the file" in err
    assert "reply: -> get_angles" in run("./FEFE0220FA", cwd=tmp_path)[1]
    assert "request: get_angles()" in run("0xFEFE0220FA", cwd=tmp_path)[1]
    assert "reply: -> get_angles" in run("FEFE0220FA", "--raw", cwd=tmp_path)[1]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nosuch.bin"], "nosuch.bin: no such file"),
        (["/nope"], "/nope: no such file"),
        (["nope"], "nope: no such file"),
        (["a.bin", "b.bin"], "a.bin: no such file"),
        (["/nope", "FE"], "/nope: no such file"),
        (["*.nope"], "*.nope: no such file"),
        (["FE", "F"], "FE F is not hex; give pairs of hex digits, one FILE, or -"),
        (["."], ".: the folder holds no file"),
        (["-", "FE"], "- is standard input; it cannot be combined with files or bytes"),
    ],
)
@pytest.mark.parametrize("format", [[], ["--raw"]], ids=["detected", "raw"])
def test_argument_that_is_neither_hex_nor_a_file_is_rejected(
    tmp_path: Path, words: list[str], message: str, format: list[str]
) -> None:
    code, out, err = run(*words, *format, cwd=tmp_path)
    assert (code, out) == (2, "")
    assert err == f"cobotwire: {message}\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "one.bin").write_bytes(ANGLES)
    (tmp_path / "two.bin").write_bytes(READ + ANGLES)
    (tmp_path / "three.hex").write_text(ANGLES.hex())
    (tmp_path / "FEFE0220FA").write_bytes(ANGLES)
    (tmp_path / ".hidden").write_bytes(READ)
    (tmp_path / "inner").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    ("words", "names"),
    [
        (["two.bin", "one.bin"], ["two.bin", "one.bin"]),
        (["*.bin"], ["one.bin", "two.bin"]),
        (["three.hex", "o*"], ["three.hex", "one.bin"]),
        (["F*", "one.bin"], ["./FEFE0220FA", "one.bin"]),
        (["."], ["./FEFE0220FA", "./one.bin", "./three.hex", "./two.bin"]),
    ],
)
def test_files_patterns_and_folders_are_decoded_file_by_file(
    folder: Path, words: list[str], names: list[str]
) -> None:
    _, out, _ = run(*words, cwd=folder)
    expected = "".join(f"{name}:\n" + run(name, cwd=folder)[1] for name in names)
    assert out == expected
    code, out, _ = run(*words, "--json", cwd=folder)
    entries = [json.loads(line) for line in out.splitlines()]
    assert [*dict.fromkeys(entry["file"] for entry in entries)] == names
    assert code == int(any(name.endswith("two.bin") for name in names))
    _, out, _ = run(*words, "--summary", "--json", cwd=folder)
    assert json.loads(out)["frames"] == {"0x20 get_angles": len(names)}


def test_pattern_that_matches_one_file_is_decoded_like_the_file(folder: Path) -> None:
    assert run("tw*", cwd=folder) == run("two.bin", cwd=folder)


def test_missing_file_is_reported_before_any_file_is_decoded(folder: Path) -> None:
    assert run("one.bin", "nope.bin", cwd=folder) == (2, "", "cobotwire: nope.bin: no such file\n")
