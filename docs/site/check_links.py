#!/usr/bin/python3
"""Whether everything a site's pages point to is there: check_links.py FOLDER

Files, and places within pages, that links, pictures, scripts and styles name; nothing that a page
loads may come from a network. Prints a line per failure and ends with 1 if there was any.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("source", "src")}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.ids, self.targets = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value is None:
                continue
            if name in ("id", "name"):
                self.ids.add(value)
            if name in ("src", "href"):
                self.targets.append(((tag, name), value))


def failures_of(path, pages):
    for where, target in pages[path].targets:
        parts = urlsplit(target)
        if parts.scheme or parts.netloc:
            if where in LOADED and parts.scheme not in ("data",):
                yield f"loads {target} from a network"
            continue
        goal = (path.parent / unquote(parts.path)).resolve() if parts.path else path
        if goal.is_dir():
            goal = goal / "index.html"
        if not goal.is_file():
            yield f"{target} is not there"
        elif parts.fragment and goal in pages and unquote(parts.fragment) not in pages[goal].ids:
            yield f"{target}: no such place in that page"


def main():
    root = Path(sys.argv[1]).resolve()
    # The pages of the C++ reference are Doxygen's own; 404.html stands at no fixed place.
    ours = [path for path in root.rglob("*.html") if "api" not in path.parts and path.name != "404.html"]
    pages = {path: Page(path) for path in ours}
    failures = [f"{path.relative_to(root)}: {words}" for path in ours for words in failures_of(path, pages)]
    print("\n".join(failures), end="\n" if failures else "", file=sys.stderr)
    print(f"{len(pages)} pages, {sum(len(page.targets) for page in pages.values())} links")
    sys.exit(1 if failures else 0)


main()
