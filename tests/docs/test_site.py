"""Build the docs site without warnings, dead links, or content from other hosts."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

import npm_package
from newcomer.website.blocks import commands, programs
from strategies import TABLES
from targets.decoder.browser import SHOWN, needs_chromium, new_tab
from vectors import NOT_ON_SITE, ROOT

SITE = "https://cobotwire.github.io/cobotwire/"
REPOSITORY = re.compile(r"https://github\.com/cobotwire/cobotwire/(?:blob|tree|edit)/main/([^#?]+)")

# The elements that make a browser load content, and the attribute that names the content.
LOADED = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """Collect what a page links to, what it loads, and the ids that links can name."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.ids: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = {name: value or "" for name, value in attrs}
        self.ids |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if found.get(LOADED.get(tag, "")):
            self.loads.append(found[LOADED[tag]])


def _left_out(path: Path) -> bool:
    """Return whether a page of the site is about an edition outside of the sample."""
    return path.parts[0] in ("reference", "robots") and Path(path.parts[1]).stem in NOT_ON_SITE


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    """Return every page of the site by its path."""
    return {path: Page(path) for path in site.rglob("*.html")}


def test_every_markdown_file_becomes_a_page(site: Path) -> None:
    texts = {path.relative_to(ROOT / "docs") for path in (ROOT / "docs").rglob("*.md")}
    texts = {path for path in texts if "_build" not in path.parts and not _left_out(path)}
    assert len(texts) > 30
    for text in texts:
        assert (site / text.with_suffix(".html")).is_file(), text


def test_generated_pages_have_no_commands_and_no_programs(site: Path) -> None:
    assert site.is_dir()  # building the site writes the pages
    texts = [path.read_text("utf-8") for path in (ROOT / "docs" / "reference").rglob("*.md")]
    assert len(texts) > 100
    assert [line for text in texts for line in commands(text)] == []
    assert [block for text in texts for block in programs(text)] == []


def test_every_link_leads_to_an_existing_place(site: Path, pages: dict[Path, Page]) -> None:
    dead = [problem for path, page in pages.items() for problem in _dead(site, pages, path, page)]
    assert dead == []
    assert sum(len(page.links) for page in pages.values()) > 1000


def test_former_address_of_a_page_leads_to_its_new_one(pages: dict[Path, Page], site: Path) -> None:
    assert pages[site / "exchange.html"].links == ["contribute/exchange.html"]


def _dead(site: Path, pages: dict[Path, Page], path: Path, page: Page) -> Iterator[str]:
    for link in page.links:
        # Pages that are also read on GitHub link to generated pages by their URL on the site.
        parts = urlsplit(link.replace(SITE, f"{site}/"))
        if parts.scheme:
            found = REPOSITORY.match(link)
            if found and not (ROOT / unquote(found[1])).exists():
                yield f"{path.relative_to(site)}: {link}"
            continue
        target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
        place = f"{path.relative_to(site)}: {link}"
        if not target.is_file():
            if not _left_out(target.relative_to(site)):
                yield place
        elif (
            parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].ids
        ):
            yield f"{place}: no such place on that page"


def test_pages_load_nothing_from_other_hosts(pages: dict[Path, Page]) -> None:
    loads = {load for page in pages.values() for load in page.loads}
    assert loads
    assert [load for load in loads if urlsplit(load).scheme or load.startswith("//")] == []


def test_client_page_shows_methods_and_no_signatures_without_meaning(site: Path) -> None:
    methods = (site / "api" / "client.html").read_text(encoding="utf-8")
    names = ("MovingClient.move_angles", "MovingClient.open_gripper", "Client.stream")
    assert [name for name in names if name not in methods] == []
    noisy = [page for page in site.glob("api/*.html") if "**kwargs" in page.read_text("utf-8")]
    assert noisy == []


def test_pages_link_to_their_source_and_generated_pages_to_the_spec(
    site: Path, pages: dict[Path, Page]
) -> None:
    repository = "https://github.com/cobotwire/cobotwire"
    assert f"{repository}/edit/main/docs/start.md" in pages[site / "start.html"].links
    for generated in ("reference/mycobot280/motion.html", "robots/mycobot280.html"):
        assert f"{repository}/tree/main/spec" in pages[site / generated].links


@needs_chromium
@pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
def test_decoder_page_of_the_site_decodes_a_request_of_each_edition(site: Path) -> None:
    tab = new_tab()
    tab.open((site / "decoder.html").as_uri())
    tab.evaluate(SHOWN)
    for edition in sorted(TABLES):
        state = json.dumps({"edition": edition, "hex": "FEFE0220FA"})
        shown = tab.evaluate(f"shown({state})")
        assert "request at 0: <code>get_angles</code>" in shown
