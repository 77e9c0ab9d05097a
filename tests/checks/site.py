#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pages of the built site: each has a title and one heading of the first kind, each link and picture leads to a file and to a
place in it, nothing is taken from the network.
usage: site.py SITE_FOLDER"""
import html.parser
import sys
from pathlib import Path
from urllib.parse import unquote


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.title, self.headings, self.links, self.places, self.foreign, self.in_title = "", 0, [], set(), [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.places |= {given.get("id"), given.get("name")}
        self.in_title = tag == "title"
        self.headings += tag == "h1"
        for link in (given.get("href"), given.get("src")):
            if link and "://" in link:
                self.foreign += [link] if tag != "a" else []
            elif link and not link.startswith(("mailto:", "data:")):
                self.links.append(link)

    def handle_data(self, data):
        self.title += data if self.in_title else ""

    def handle_endtag(self, tag):
        self.in_title = False


site = Path(sys.argv[1]).resolve()
pages = {path: Page(path.read_text()) for path in site.rglob("*.html")}
problems, links = [], 0
for path, page in sorted(pages.items()):
    def complain(what):
        problems.append(f"{path.relative_to(site)}: {what}")
    if not page.title.strip():
        complain("no title")
    if page.headings != 1:
        complain(f"{page.headings} headings of the first kind")
    for link in page.foreign:
        complain(f"{link} is taken from the network")
    for link in page.links if path.name != "404.html" else []:
        links += 1
        name, _, place = link.partition("#")
        to = (path.parent / unquote(name)).resolve() if name else path
        if to.is_dir():
            to = to / "index.html"
        if not to.is_file():
            complain(f"{link} leads nowhere")
        elif place and to in pages and unquote(place) not in pages[to].places:
            complain(f"{link}: there is no such place")
print("\n".join(problems) or f"{len(pages)} pages, {links} links")
sys.exit(1 if problems or len(pages) < 50 or links < 1000 else 0)
