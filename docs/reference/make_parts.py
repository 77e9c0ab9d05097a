#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes parts.md, an index of the public names of the headers, or checks that it is up to date.

A public name is a class, structure, concept, function, alias or constant of a namespace of fibrant that is not called detail. One
without a comment is an error. Constants are not listed.
usage: make_parts.py [--check]
"""
import re
import sys

sys.dont_write_bytecode = True  # no folder beside the pages
from header_pages import by_folder, cell, finish, headers

NAME = re.compile(r"(?:(?:inline|constexpr|extern|static) )*(?:"
                  r"(?:struct|class|concept|enum class) (?P<type>\w+)(?! *(?:\w|;|<))|"
                  r"using (?P<alias>\w+) =|"
                  r"(?!using|namespace|return|friend|#|static_assert|requires|extern|template)"
                  r"[\w:<>,&* \[\]]*?[\w>&*\]] [&*]?(?P<function>\w+)\()")

CONSTANT = re.compile(r"(?:inline )?constexpr [\w:<>,* ]+? (\w+)(?:\[\w*\])?(?: =|\{)")


def without(text):
    """The text without comments, but for `///` and what ends a namespace."""
    return re.sub(r"(?<!/)//(?!/)(?! namespace)[^\n]*", "", text)


def names(source):
    """(name, its comment or nothing, whether it is a constant) of a header, in order; names that follow each other without a blank
    line share a comment."""
    found, comment, group, inner, head = [], [], "", False, ""
    for line in without(source).split("\n"):
        if inner:  # a namespace of details
            if re.match(r"} +// namespace (?:\w+::)*detail", line):
                inner = False
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
        constant = CONSTANT.match(line)
        if (name or constant) and not line.startswith(" "):
            group = " ".join(comment) or (line.split("///<")[1].strip() if "///<" in line else "") or group
            found.append((constant[1] if constant else name["type"] or name["alias"] or name["function"], group, bool(constant)))
        if not line.startswith((" ", "template", "requires", "[[")):
            comment, head = [], ""
    return found


def sentence(comment):
    """The first sentence of a comment, without commands of Doxygen."""
    plain = re.split(r"\s*@(?:param|tparam|throws)\b", comment.replace("@returns ", ""))[0]
    return re.split(r"(?<=[.:]) +(?=[A-Z])| - ", plain)[0].rstrip(":").rstrip(".")


def page():
    text, missing, count = [], [], 0
    for folder, own in by_folder():
        rows = []
        for header in own:
            said, unlisted, place = {}, set(), header.relative_to(headers)
            for name, comment, constant in names(header.read_text()):
                said[name] = said.get(name) or sentence(comment)
                unlisted |= {name} if constant else set()
            for name, comment in said.items():
                count += 1
                if not comment:
                    missing.append(f"fibrant/{place}: {name} has no sentence")
                if name not in unlisted:
                    rows.append(f"| `{name}` | `{place}` | {cell(comment)} |")
        if rows:
            text.append(f"## {folder.name}\n\n| name | header | what it is |\n|---|---|---|\n" + "\n".join(rows) + "\n")
    head = ("# Index of the C++ parts\n\nMade from the headers by [make_parts.py](make_parts.py): each public name, the header "
            "that has it, below `fibrant/`, and the first sentence\nof its comment. "
            "Structures of parameters have [a page with their fields](parameters.md).\n\n")
    return head + "\n".join(text), missing, count


finish("parts", *page(), least=500, what="names")
