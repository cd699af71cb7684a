"""Each page names its readers, and links to what it mentions."""

from __future__ import annotations

import re

import pytest

from newcomer.run_pages import pages
from vectors import ROOT

# These name their readers in their first sentences.
ENTRANCES = ("README.md", "docs/index.md")
PAGES = [page for page in pages() if page not in ENTRANCES]
TEXTS = [*pages(), "ARCHITECTURE.md", "CONTRIBUTING.md", "codegen/README.md", "spec/README.md"]
LINK = re.compile(r"\]\(([^)\s]+)\)")
BLOCKS = re.compile(r"^(```|:::).*?^\1$|^(?: {4}|\t)[^\n]*$", re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", PAGES)
def test_page_names_its_readers_at_the_top(page: str) -> None:
    lines = (ROOT / page).read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("# ")
    assert re.fullmatch(r"\*For .*\.\*", lines[2]), lines[2]
    assert (lines[1], lines[3]) == ("", "")


@pytest.mark.parametrize("page", TEXTS)
def test_text_links_to_the_pages_and_addresses_that_it_names(page: str) -> None:
    text = BLOCKS.sub("", (ROOT / page).read_text(encoding="utf-8"))
    without_links = re.sub(r"\[[^\]]*\]\([^)]*\)|<https?://[^>]*>", "", text)
    named = re.findall(r"`(?:docs/)[\w/-]+\.md`|(?<![`\"\w/])https?://[\w./-]+\w", without_links)
    assert named == []


@pytest.mark.parametrize("page", ["ARCHITECTURE.md", "CONTRIBUTING.md", "spec/README.md"])
def test_links_of_a_text_outside_of_the_site_lead_to_files(page: str) -> None:
    links = [link for link in LINK.findall((ROOT / page).read_text("utf-8")) if "://" not in link]
    folder = (ROOT / page).parent
    assert [link for link in links if not (folder / link.partition("#")[0]).exists()] == []
