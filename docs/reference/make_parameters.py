#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes parameters.md, a table of each C++ structure of parameters, from the headers, or checks that it is up to date.

A structure of parameters has a member validate(). What each field is stands in its comment, what it may be in the checks of
validate(); both are taken from there. A field without a comment is an error.
usage: make_parameters.py [--check]
"""
import re
import sys

sys.dont_write_bytecode = True  # no folder beside the pages
from header_pages import by_folder, cell, finish, headers

BOUNDS = {
    "require_positive": lambda a: "> 0",
    "require_not_negative": lambda a: ">= 0",
    "require_finite": lambda a: "finite",
    "require_at_least": lambda a: f">= {a[0]}",
    "require_at_most": lambda a: f"<= {a[0]}",
    "require_between": lambda a: f"in [{a[0]}, {a[1]}]",
}

CHECKED_ELSEWHERE = ("Stage", "Ramp")  # by the run that they are stages of


def masked(text):
    """The same with texts and comments blanked out, so that brackets in them do not count."""
    return re.sub(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|\'(?:\\.|[^\'\\\n])\'', lambda found: "_" * len(found[0]), text)


def closing(text, start):
    """Position behind the bracket that closes the one at `start`."""
    depth = 0
    for place, sign in enumerate(masked(text)[start:], start):
        depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(sign, 0)
        if depth == 0:
            return place + 1
    raise SystemExit(f"no closing bracket after {text[start:start + 60]!r}")


def parts(text):
    """Arguments of a call, split at commas outside of brackets."""
    depth, found = 0, [""]
    for sign, plain in zip(text, masked(text)):
        depth += {"(": 1, "{": 1, "[": 1, ")": -1, "}": -1, "]": -1}.get(plain, 0)
        if plain == "," and depth == 0:
            found.append("")
        else:
            found[-1] += sign
    return [part.strip() for part in found]


def bounds(validate, field, others):
    """What validate() asks of a field, in its words; not what it asks of fields of that name in the other ones."""
    said = []
    for call in re.finditer(r"(?:core::)?(require\w*)\s*\(", validate):
        arguments = parts(validate[call.end():closing(validate, call.end() - 1) - 1])
        named = next((a for a in arguments if re.fullmatch(r'"[\w.\[\]]*\b' + field + '"', a)), None)
        if named is None or set(named.strip('"').split(".")[1:-1]) & set(others):
            continue
        if call[1] in BOUNDS:
            said.append(BOUNDS[call[1]](arguments[arguments.index(named) + 2:]))
        elif arguments[-1].startswith('"'):
            # Texts that are put together: the name of the value stands in the place of its text, once.
            text = re.sub(r'" \+ (?:core::)?text\(([^()]*)\)(?: \+ "|$)', r"\1", arguments[-1]).strip('"')
            said.append(re.sub(r"\b(\w+)(?:,| =) \1\b", r"\1", re.sub(r'" \+ \w+ \+ "', "...", text)))
    return "; ".join(dict.fromkeys(said))


STRUCTURE = re.compile(r"((?:^ *///[^\n]*\n)*)^ *(?:template <[^\n]*>\n *)?struct (\w+)(?: final)?(?: : ([^{\n]*))? \{\n", re.M)


def structures(text):
    """Head and body of all structures; of the head: comment, name, bases."""
    for found in STRUCTURE.finditer(text):
        body = text[found.end() - 2:closing(text, found.end() - 2)]
        yield found, body


FIELD = re.compile(r"^ +(?P<type>(?:typename )?[A-Za-z_][\w:]*(?:<[^;=\n]*>)?) (?P<rest>\w+[^;()\n]*(?:\{[^;\n]*\}|\([^;\n]*\))?[^;\n]*);"
                   r" *(?P<comment>///<[^\n]*)?$")
NO_FIELD = re.compile(r" *(using|static|friend|return|explicit|constexpr|template|struct|class|public|private)\b")


def fields(body):
    """(type, name, default, comment) of the members of a structure, those of structures in it left out."""
    flat = body[1:-1]
    # Functions and structures within are cut out, what stands before them stays.
    place, kept = 0, ""
    plain = masked(flat)
    while (brace := re.compile(r"\)[^;{}>_\n]*(?:\n[^;{}>_\n]*)?\{|(?:struct|enum class) [^;{\n]*\{").search(plain, place)):
        kept += flat[place:flat.rfind("\n", 0, brace.start()) + 1]
        place = closing(flat, brace.end() - 1)
    kept += flat[place:]
    kept = re.sub(r"^( +[A-Za-z_][\w:]*<[^;=\n(){}]*>)\n +(?=\w+\{)", r"\1 ", kept, flags=re.M)  # a type that fills its line
    lines, pending = re.sub(r" =\n *", " = ", kept).split("\n"), []
    for number, line in enumerate(lines):
        stripped = line.strip()
        if stripped.startswith("///") and not stripped.startswith("///<"):
            pending.append(stripped[3:].strip())
            continue
        found = FIELD.match(line)
        if found and not NO_FIELD.match(line):
            comment = found["comment"][4:].strip() if found["comment"] else ""
            more = number + 1
            while comment and more < len(lines) and lines[more].strip().startswith("///<"):
                comment += " " + lines[more].strip()[4:].strip()
                more += 1
            yield found["type"], found["rest"], comment or " ".join(pending)
        if stripped:
            pending = []


def page():
    text, missing, count = [], [], 0
    for folder, own in by_folder():
        tables = []
        for header in own:
            source = header.read_text()
            for found, body in structures(source):
                validate = re.search(r"void validate\(\) const \{", body)
                if not validate and found[2] not in CHECKED_ELSEWHERE:
                    continue
                checks = body[validate.end() - 1:closing(body, validate.end() - 1)] if validate else ""
                rows, members = [], list(fields(body))
                names = [re.match(r"\w+", one)[0] for _, rest, _ in members for one in parts(rest)]
                for kind, rest, comment in members:
                    for one in parts(rest):
                        name, _, default = one.partition("=")
                        name, brace, inside = name.partition("{")
                        default = default.strip() or (inside.rstrip("}") if brace else "")
                        unit = re.search(r"\[([^\]]*)\](?=[,.;]?(?: |$)|$)", comment)
                        said = bounds(checks, name.strip(), names)
                        whole = f"{found[2]}.{name.strip()}"
                        if not comment and re.search(r"(Parameters|Detection|Spacing|Rule|Adaptation|Material)$", kind):
                            comment = "a structure of its own"
                        elif not comment:
                            missing.append(f"{header.relative_to(headers.parent)}: {whole} has no comment")
                        rows.append(f"| `{name.strip()}` | `{kind}` | {f'`{default}`' if default else '-'} | "
                                    f"{unit[1] if unit else '-'} | {cell(said)} | {cell(comment)} |")
                        count += 1
                outer = ""
                if found[2] == "Parameters":
                    before = [m for m in re.finditer(r"^(?:class|struct) (\w+)", source[:found.start()], re.M)]
                    outer = before[-1][1] + "::" if before else ""
                if rows:
                    lead = " ".join(line.strip()[3:].strip() for line in found[1].strip().split("\n") if line.strip())
                    tables.append(f"### `{outer}{found[2]}`\n\n`<fibrant/{header.relative_to(headers)}>`" +
                                  (f", with all of `{found[3].strip()}`" if found[3] else "") + (f": {lead}" if lead else "") +
                                  "\n\n| field | type | default | unit | bound | meaning |\n|---|---|---|---|---|---|\n" +
                                  "\n".join(rows) + "\n")
        if tables:
            text.append(f"## {folder.name}\n\n" + "\n".join(tables))
    head = ("# Parameters of the C++ parts\n\nMade from the headers by [make_parameters.py](make_parameters.py). What is `core::unset` has to be "
            "given, or follows from\nsomething else, as its meaning tells. What is out of bound is refused by name and value before any work.\n"
            "Keys of scene files have [pages of their own](index.md#programs).\n\n")
    return head + "\n".join(text), missing, count


finish("parameters", *page(), least=200, what="parameters")
