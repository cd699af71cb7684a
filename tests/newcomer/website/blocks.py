"""Find the shell commands and the Python programs of a page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

# A block with a line that starts with one of these holds commands, unless it is in another
# language.
PROGRAMS = {
    *("cobotwire", "cobotwire-gen", "python", "python3", "pip", "pipx", "pytest", "make", "eval"),
    *("tshark", "wireshark", "socat", "ser2net", "gcc", "arm-none-eabi-gcc", "cargo", "git"),
    *("sudo", "apt-get", "uv", "docker", "npm", "curl"),
}
SHELL = ("", "sh", "bash", "shell", "text", "indented")
FENCE = re.compile(r"(?P<ticks>```+)(?P<kind>.*)")
NAMED = re.compile(r"<!-- (?:file|append): \S+ -->")


class Block(NamedTuple):
    """A block of code of a page: a fenced one with its language, or an indented one."""

    kind: str
    text: str
    line: int
    # Whether the page names a file for it, which docs.pages writes.
    named: bool = False
    # The text block directly after it: what it prints.
    shown: str | None = None


def blocks(page: str) -> list[Block]:
    """Return the blocks of a page in their order."""
    lines = [*page.splitlines(), ""]
    found: list[Block] = []
    at, end = 0, -1
    while at < len(lines):
        if fence := FENCE.match(lines[at]):
            last = next(i for i in range(at + 1, len(lines)) if lines[i].strip() == fence["ticks"])
        elif lines[at].startswith("    ") and not lines[at - 1].strip():
            last = next((i for i in range(at, len(lines)) if _ends(lines, i)), len(lines))
        else:
            at += 1
            continue
        text = "\n".join(line.removeprefix("" if fence else "    ") for line in lines[at:last])
        text = text.partition("\n")[2] if fence else text
        kind = fence["kind"].strip() if fence else "indented"
        if kind == "text" and found and found[-1].kind == "python" and not "".join(lines[end:at]):
            found[-1] = found[-1]._replace(shown=f"{text}\n")
        else:
            named = bool(NAMED.fullmatch(lines[at - 1]))
            found.append(Block(kind, f"{text.rstrip()}\n", at + 1, named))
        at = end = last + bool(fence)
    return found


def _ends(lines: list[str], at: int) -> bool:
    """Return whether an indented block has ended before this line."""
    return bool(lines[at].strip()) and not lines[at].startswith("    ")


def commands(page: str) -> Iterator[str]:
    """Yield the shell commands, without comments, except those of ``console`` blocks."""
    for block in blocks(page):
        if block.kind in SHELL and block.shown is None:
            lines = block.text.replace("\\\n", "").splitlines()
            if any(line.partition(" ")[0] in PROGRAMS for line in lines):
                yield from (_bare(line) for line in lines if _bare(line))


def _bare(line: str) -> str:
    """Return a command without its comment, with single spaces."""
    return re.sub(r"(^|\s+)#( .*|$)", "", re.sub(r" {2,}", " ", line)).strip()


def console(page: str) -> Iterator[str]:
    """Yield the commands of ``console`` blocks, whose output follows them."""
    for block in blocks(page):
        if block.kind == "console":
            yield from re.findall(r"^\$ (.*)$", block.text, re.MULTILINE)


def programs(page: str) -> Iterator[Block]:
    """Yield the Python blocks that are not files; console commands run the files."""
    return (each for each in blocks(page) if each.kind == "python" and not each.named)
