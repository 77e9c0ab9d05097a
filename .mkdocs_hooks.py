# SPDX-License-Identifier: MIT
"""Links that leave docs (to examples, tests, the README) lead to copies of these files beside the site's pages. The index of the
search is a script as well, which a page that is opened from a file may load (docs/site.js)."""
import posixpath
import re
import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parent
linked = set()


def on_page_markdown(markdown, page, config, files):
    here = posixpath.dirname(page.file.src_path)

    def mend(match):
        text, link = match.groups()
        path = posixpath.normpath(posixpath.join("docs", here, link.split("#")[0]))
        if "://" in link or link.startswith("#") or path.startswith("docs/") or not (ROOT / path).is_file():
            return match.group(0)
        linked.add(path)
        return '<a href="%s">%s</a>' % (posixpath.relpath("source/" + path + ".txt", here or "."), text)

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", mend, markdown)


def on_post_build(config):
    for path in sorted(linked):
        to = Path(config["site_dir"]) / "source" / (path + ".txt")
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / path, to)
    index = Path(config["site_dir"]) / "search" / "search_index.json"
    index.with_name("index.js").write_text("window.searchIndex = " + index.read_text() + ";\n")
