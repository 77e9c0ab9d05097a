#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes parts.md, an index of the public names of the headers, or checks that it is up to date.

A public name is a class, structure, concept or function of a namespace of fibrant that is not called detail. One without a
comment is an error.
usage: make_parts.py [--check]
"""
import pathlib
import re
import sys

here = pathlib.Path(__file__).resolve().parent
headers = here.parent.parent / "include" / "fibrant"
NAME = re.compile(r"(?:(?:inline|constexpr|extern|static) )*(?:"
                  r"(?:struct|class|concept|enum class) (?P<type>\w+)(?! *(?:\w|;|<))|"
                  r"(?!using|namespace|return|friend|#|static_assert|requires|extern|template)"
                  r"[\w:<>,&* \[\]]*?[\w>&*\]] [&*]?(?P<function>\w+)\()")


def without(text):
    """The text without comments, but for lines of `///`, and with texts and what is in braces of code kept as it is."""
    return re.sub(r"(?<!/)//(?!/)(?! namespace)[^\n]*", "", text)


def names(source):
    """(name, its comment or nothing) of a header, in order; names that follow each other without a blank line share a comment."""
    found, comment, group, inner, head = [], [], "", None, ""
    for line in without(source).split("\n"):
        if inner:  # a namespace of details
            if re.match(r"} +// namespace (?:\w+::)*detail", line):
                inner = None
            continue
        if re.match(r"namespace (?:\w+::)*detail\b", line):
            inner = True
            continue
        if line.startswith("///"):
            comment.append(line[3:].strip())
            continue
        if not line.strip():
            comment, group, head = [], "", ""
            continue
        if line.startswith(("template", "requires", "[[")) or head:
            head = (head + " " + line).strip()
        name = NAME.match(line) or (NAME.match(re.sub(r"^template <.*?> (?=\w)|^\[\[\w+\]\] ?", "", head)) if head else None)
        if name and not line.startswith(" "):
            group = " ".join(comment) or group
            found.append((name["type"] or name["function"], group))
        if not line.startswith((" ", "template", "requires", "[[")):
            comment, head = [], ""
    return found


def sentence(comment):
    """The first sentence of a comment, without commands of Doxygen."""
    plain = re.split(r"\s*@(?:param|tparam|throws)\b", comment.replace("@returns ", ""))[0]
    return re.split(r"(?<=[.:]) +(?=[A-Z])| - ", plain)[0].rstrip(":").rstrip(".")


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;")


def page():
    text, missing, count = [], [], 0
    for folder in sorted(path for path in headers.iterdir() if path.is_dir()):
        rows = []
        for header in sorted(folder.rglob("*.hpp")):
            source = header.read_text()
            said, whole = {}, f"fibrant/{header.relative_to(headers)}"
            for name, comment in names(source):
                said[name] = said.get(name) or sentence(comment)
            for name, comment in said.items():
                count += 1
                if not comment:
                    missing.append(f"{whole}: {name} has no sentence")
                rows.append(f"| `{name}` | `{whole[8:]}` | {cell(comment)} |")
        if rows:
            text.append(f"## {folder.name}\n\n| name | header | what it is |\n|---|---|---|\n" + "\n".join(rows) + "\n")
    head = ("# Index of the C++ parts\n\nMade from the headers by [make_parts.py](make_parts.py): each public name, the header that has it, below `fibrant/`, "
            "and the first sentence\nof its comment. Structures of parameters have [a page with their fields](parameters.md).\n\n")
    return head + "\n".join(text), missing, count


made, missing, count = page()
target = here / "parts.md"
if "--check" not in sys.argv:
    target.write_text(made)
elif not target.exists() or target.read_text() != made:
    missing.append("docs/reference/parts.md is not what the headers say: python3 docs/reference/make_parts.py")
if count < 500:
    missing.append(f"only {count} names were found: the headers are read wrongly")
print(f"{count} names", *missing, sep="\n")
sys.exit(1 if missing else 0)
