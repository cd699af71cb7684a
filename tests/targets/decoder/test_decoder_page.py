"""The decoder page shows pasted bytes, byte by byte, as the codec reads them."""

from __future__ import annotations

import html
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlencode

import pytest

import npm_package
import vectors
from cobotwire.codec.interface import Noise
from cobotwire.diagnose.explain import frame_parts
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.project import edition_files
from cobotwire_codegen.targets.decoder import edition_script, render_decoder
from strategies import TABLES, codec_of
from targets.decoder.browser import SHOWN, Tab, needs_chromium, new_tab
from targets.expected import codec_of_edition
from targets.specs import edition_of
from targets.typescript.comparison import package
from targets.vectors.comparison import Record, read
from vectors import ROOT

PAGE = (ROOT / "docs" / "decoder.md").read_text()
STREAMS = 2
DIRECTIONS = ("both", "request", "reply")
NOTATIONS = [
    ("b'\\xfe\\xfe\\x02\\x20\\xfa'", "request at 0"),
    ("[0xFE, 0xFE, 0x2, 0x20, 0xFA]", "request at 0"),
    ("fefe0220fa", "request at 0"),
    ("FE FE 02 2", "odd number of digits"),
    ("hello <script>", "not hex"),
]
WRONG = "FE FE 03 12 07 FA"
pytestmark = [
    needs_chromium,
    pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing()),
]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the page's own HTML, without the site around it."""
    package()
    path = tmp_path_factory.mktemp("decoder") / "decoder.html"
    body = re.findall(r"^```\{raw\} html\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)[0]
    path.write_text(f'<!doctype html><meta charset="utf-8"><body>{body}</body>')
    static = path.parent / "_static"
    shutil.copytree(ROOT / "docs" / "_static", static, ignore=shutil.ignore_patterns("editions"))
    scripts = render_decoder([*vectors.editions().values()])
    write(Target(static / "decoder" / "editions", scripts))
    return path


@pytest.fixture(scope="module")
def tab() -> Tab:
    return new_tab()


def _open(tab: Tab, page: Path, **state: str) -> Tab:
    """Open the page anew, with a state in its address."""
    tab.open("about:blank")
    tab.open(f"{page.as_uri()}#{urlencode(state)}")
    tab.evaluate(SHOWN)
    return tab


def _shown(tab: Tab, page: Path, **state: str) -> str:
    """Return what the page shows of the state in its address."""
    return html.unescape(_open(tab, page, **state).evaluate("shown()"))


@pytest.fixture(scope="module")
def typed(tab: Tab, page: Path) -> dict[str, str]:
    """Return what the page shows of each pasted text."""
    states = [*_streams(), *(_state(pasted) for pasted, _ in NOTATIONS), _state(WRONG, "reply")]
    _open(tab, page)
    return {each["hex"]: tab.evaluate(f"shown({json.dumps(each)})") for each in states}


def _state(pasted: str, direction: str = "both", edition: str = "mycobot") -> dict[str, str]:
    return {"edition": edition, "direction": direction, "hex": pasted}


def _streams() -> Iterator[dict[str, str]]:
    for edition in sorted(TABLES):
        for record in _longest(edition):
            yield _state(record["bytes"], record["direction"], edition)


def _longest(edition: str) -> list[Record]:
    return sorted(read(edition)["streams"], key=lambda record: -len(record["events"]))[:STREAMS]


def _cells(shown: str) -> list[list[str]]:
    rows = re.findall(r"<tr><td>(.*?)</tr>", shown, re.DOTALL)
    return [re.sub(r"<[^>]*>", "\t", row).split("\t") for row in rows]


def test_decoder_page_offers_every_edition_of_the_spec(tab: Tab, page: Path) -> None:
    options = "[...document.querySelectorAll('option')].map((each) => each.value)"
    found = _open(tab, page).evaluate(options)
    assert found[: -len(DIRECTIONS)] == sorted(path.stem for path in edition_files(ROOT))


EXPLAINED = [
    "FE FE 04 22 53 36 FA",
    "FE FE 12 20 CD CC CC 3D 3F F8 00 00 00 00 00 00 00 00 C0 7F FA",
    "FE FE 17 26 6C 65 66 74 00 00 00 00 00 01 02 03 C3 A0 20 63 C3 B4 74 C3 A9 FA",
    "FE FE 10 29 01 08 05 00 00 00 47 50 53 20 E9 20 20 20 FA",
]


def test_page_without_the_module_names_the_command_that_decodes(tab: Tab, page: Path) -> None:
    bare = page.with_name("bare.html")
    bare.write_text(page.read_text().replace("module.js", "none.js"))
    tab.open(bare.as_uri())
    assert "cobotwire decode" in tab.evaluate("document.getElementById('decoder').textContent")


def test_message_without_a_request_is_shown_as_an_event(tab: Tab, page: Path) -> None:
    [found] = [
        vector
        for vector in vectors.edition("mercury_a1").vectors
        if vector.command == "motion_ended" and vector.frame and vector.direction == "reply"
    ][:1]
    assert found.frame is not None
    shown = _shown(tab, page, edition="mercury_a1", hex=found.frame.hex(" "), direction="reply")
    assert "event at 0: <code>motion_ended</code>" in shown


def test_each_type_of_the_language_is_explained(tab: Tab, page: Path) -> None:
    edition = edition_of("sensor")
    own, codec = page.with_name("sensor.html"), codec_of_edition(edition)
    script = f"<script>{edition_script(edition)}</script></body>"
    own.write_text(page.read_text().replace("</body>", script))
    _open(tab, own)
    for pasted in EXPLAINED:
        text = tab.evaluate(f"shown({json.dumps(_state(pasted, 'reply', 'sensor'))})")
        rows = [[cell for cell in row if cell] for row in _cells(html.unescape(text))]
        frame = bytes.fromhex(pasted)
        parts = list(frame_parts(codec.table, frame, codec.decode("reply", frame)))
        cells = [(p.offset, p.data.hex(" ").upper(), p.name, p.raw, p.meaning) for p in parts]
        assert rows == [[str(cell) for cell in row if cell not in ("", None)] for row in cells]


def test_each_byte_of_a_frame_is_labelled(tab: Tab, page: Path) -> None:
    shown = _shown(tab, page, edition="mycobot", hex="FE FE 06 21 01 00 1D 14 FA", direction="both")
    rows = [[cell for cell in row if cell] for row in _cells(shown)]
    assert rows == [
        ["0", "FE FE", "header", "a frame starts here"],
        ["2", "06", "LEN", "6: 6 bytes follow"],
        ["3", "21", "CMD", "send_angle: Send one joint to an angle"],
        ["4", "01", "joint", "1", "1"],
        ["5", "00 1D", "angle", "29", "0.29 degrees"],
        ["7", "14", "speed", "20", "20 percent"],
        ["8", "FA", "footer", "the frame ends here"],
    ]
    assert "request at 0: <code>send_angle</code>" in shown


def test_page_without_an_edition_in_its_address_decodes_as_todays_arm(tab: Tab, page: Path) -> None:
    # 0x02 is a command of mycobot280 only.
    assert "get_system_version" in _shown(tab, page, hex="FE FE 02 02 FA", direction="request")


@pytest.mark.parametrize("edition", sorted(TABLES))
def test_decoder_page_shows_the_events_of_the_codec(typed: dict[str, str], edition: str) -> None:
    for record in _longest(edition):
        data = bytes.fromhex(record["bytes"])
        framer = codec_of(edition, "reference").framer(record["direction"])
        events = [*framer.feed(data), *framer.flush()]
        shown = typed[record["bytes"]]
        for event in events:
            kind = f"noise at {event.offset}" if isinstance(event, Noise) else f"at {event.offset}:"
            assert kind in shown
        frames = sum(not isinstance(event, Noise) for event in events)
        assert f"{len(data)} bytes: {frames} frame{'' if frames == 1 else 's'}, " in shown


@pytest.mark.parametrize(("pasted", "shown_text"), NOTATIONS)
def test_hex_in_any_notation_is_read_or_its_error_is_shown(
    typed: dict[str, str], pasted: str, shown_text: str
) -> None:
    assert shown_text in typed[pasted]


def test_rejected_value_is_shown_at_its_bytes(typed: dict[str, str]) -> None:
    shown = typed[WRONG]
    assert "rejected" in shown
    assert "powered is 7; allowed: True or False (at byte 4 of FE FE 03 12 07 FA)" in shown
    assert 'class="byte wrong">07' in shown


# Paste 2 MB, and note the longest time for which the page does not answer.
LONG = """
(async () => {
  const root = document.getElementById("decoder");
  const text = root.querySelector("[name=hex]");
  // Laying out a field of some megabytes takes the browser seconds by itself.
  text.style.display = "none";
  root.querySelector("[name=edition]").value = "mycobot";
  text.value = PASTED;
  const started = performance.now();
  root.dispatchEvent(new Event("input"));
  let longest = 0;
  for (let last = started; root.querySelector(".output[aria-busy]"); ) {
    await new Promise((go) => setTimeout(go, 0));
    longest = Math.max(longest, performance.now() - last);
    last = performance.now();
  }
  const output = root.querySelector(".output");
  const seconds = (performance.now() - started) / 1000;
  const nodes = output.querySelectorAll("*").length;
  return { seconds, longest: longest / 1000, text: output.textContent, nodes,
    address: location.href.length };
})()
"""
# Long inputs: headers without end, false headers in false headers, and small frames.
LONG_INPUTS = {
    "FE": '"FE ".repeat(2_000_000)',
    "FE without blanks": '"FE".repeat(2_000_000)',
    "FE FE 10": '"FE FE 10 20 ".repeat(500_000)',
    "noise and frames": '"FE FE 02 20 FA 00 ".repeat(333_333)',
    "not hex": '"xy".repeat(2_000_000)',
}


@pytest.mark.parametrize("pasted", LONG_INPUTS)
def test_page_responds_while_a_long_input_is_decoded(tab: Tab, page: Path, pasted: str) -> None:
    short = LONG_INPUTS[pasted].replace("000)", "00)").replace("333_333", "33_333")
    _open(tab, page)
    small, large = (
        tab.evaluate(LONG.replace("PASTED", text)) for text in (short, LONG_INPUTS[pasted])
    )
    # On two busy cores each takes 1 to 5 s. The first one has a tenth of the bytes.
    assert large["seconds"] < 30
    assert large["seconds"] < 40 * max(small["seconds"], 0.1)
    assert large["longest"] < 0.5 + 0.5 * large["seconds"]
    assert large["nodes"] < 10_000
    assert large["address"] < 1000
    assert ("Not hex" in large["text"]) == (pasted == "not hex")
    assert ("of noise" in large["text"]) == (pasted != "not hex")


def test_rest_of_a_long_input_is_shown_on_request(tab: Tab, page: Path) -> None:
    script = """
    (async () => {
      await shown({ edition: "mycobot", direction: "both", hex: "FE FE 02 20 FA 00 ".repeat(250) });
      const root = document.getElementById("decoder");
      const counts = [root.querySelectorAll(".event").length];
      root.querySelector("button.more").click();
      await answered(root);
      counts.push(root.querySelectorAll(".event").length);
      root.querySelector("button.more").click();
      await answered(root);
      counts.push(root.querySelectorAll(".event").length);
      counts.push(root.querySelectorAll("button.more").length);
      await shown({ edition: "mycobot", direction: "both", hex: "00 ".repeat(2500) });
      for (let turn = 0; turn < 2; turn += 1) {
        counts.push(root.querySelectorAll(".byte").length);
        root.querySelector("button.more").click();
        await answered(root);
      }
      counts.push(root.querySelectorAll(".byte").length);
      counts.push(root.querySelectorAll("button.more").length);
      return counts;
    })()
    """
    assert _open(tab, page).evaluate(script) == [200, 400, 500, 0, 1024, 2048, 2500, 0]


def test_newest_input_is_shown_if_the_page_is_still_busy_with_another(tab: Tab, page: Path) -> None:
    script = """
    (async () => {
      const root = document.getElementById("decoder");
      root.querySelector("[name=hex]").value = "FE ".repeat(1_000_000);
      root.dispatchEvent(new Event("input"));
      return shown({ hex: "FE FE 02 20 FA" });
    })()
    """
    assert "5 bytes: 1 frame, 0 bytes of noise" in _open(tab, page).evaluate(script)
