# SPDX-License-Identifier: MIT
"""What the pages that are made from the headers share: make_parameters.py, make_parts.py."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
headers = here.parent.parent / "include" / "fibrant"


def by_folder():
    """(folder, its headers), in order."""
    for folder in sorted(path for path in headers.iterdir() if path.is_dir()):
        yield folder, sorted(folder.rglob("*.hpp"))


def cell(text):
    """A text as it stands in a table."""
    return text.replace("|", "\\|").replace("<", "&lt;") or "-"


def finish(name, made, missing, count, least, what):
    """Writes the page, or with --check compares it, and ends the program: with 1 where something is missing."""
    page, script = here / f"{name}.md", f"docs/reference/make_{name}.py"
    if "--check" not in sys.argv:
        page.write_text(made)
    elif not page.exists() or page.read_text() != made:
        missing.append(f"docs/reference/{name}.md is not what the headers say: python3 {script}")
    if count < least:
        missing.append(f"only {count} {what} were found: the headers are read wrongly")
    print(f"{count} {what}", *missing, sep="\n")
    sys.exit(1 if missing else 0)
