"""Check that whatever the built documentation links to is there: python docs/check_links.py build/site."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Links(HTMLParser):
    """The addresses that a page links to."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep an address."""
        self.found += [value for name, value in attrs if value and (tag, name) in {("a", "href"), ("img", "src")}]


def broken(site: Path) -> Iterator[tuple[Path, str]]:
    """Yield each page of a site with an address on it that leads nowhere inside the site."""
    for page in sorted(site.rglob("*.html")):
        links = Links()
        links.feed(page.read_text(encoding="utf-8"))
        for address in links.found:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc or not parts.path or page.name == "404.html":
                continue
            there = page.parent / unquote(parts.path)
            if not (there.is_file() or (there / "index.html").is_file()):
                yield page.relative_to(site), address


def main() -> int:
    """Print what leads nowhere; return 1 if anything does."""
    found = list(broken(Path(sys.argv[1])))
    for page, address in found:
        print(f"{page}: {address}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
