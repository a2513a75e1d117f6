#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check a built site: every link within it leads somewhere, and no page exceeds 1,500 words but the
reference.

    docs/check_site.py FOLDER
"""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

MOST_WORDS = 1500
GENERATED = ("genindex.html", "search.html", "py-modindex.html")


class Page(HTMLParser):
    """Links, anchors and the number of words of a page's article."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.words, self.depth = [], set(), 0, 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.links += [attributes[name] for name in ("href", "src") if attributes.get(name)]
        if "id" in attributes:
            self.anchors.add(attributes["id"])
        if tag == "article":
            self.depth += 1

    def handle_endtag(self, tag):
        if tag == "article":
            self.depth -= 1

    def handle_data(self, data):
        if self.depth > 0:
            self.words += len(data.split())


def main():
    site = Path(sys.argv[1]).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    problems = []
    for path, page in pages.items():
        name = path.relative_to(site)
        if page.words > MOST_WORDS and name.parts[0] != "reference" and name.name not in GENERATED:
            problems.append(f"{name}: {page.words} words; allowed: {MOST_WORDS}")
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                problems.append(f"{name}: {link}: does not exist")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                problems.append(f"{name}: {link}: the page has no such anchor")
    print(*problems, sep="\n", end="\n" if problems else "")
    links = sum(len(page.links) for page in pages.values())
    print(f"{len(pages)} pages, {links} links, {len(problems)} problems")
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
