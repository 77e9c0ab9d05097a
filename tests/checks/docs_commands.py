#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the commands of the README, the tutorials and the how-to pages as they stand there, in a folder that looks like a clone
with its programs built: those of a page in their order, with the scenes that it says to save. What takes long is stopped by a
signal once it runs, and what needs its results is left out. Programs that this build has not are left out too, and told.
Presets and targets that pages name are there, and blocks of Python and TOML can be read.
usage: docs_commands.py PROJECT_FOLDER BIN_FOLDER SCRATCH_FOLDER"""
import ast
import json
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

LONG, PATIENCE, ENOUGH = {"weave", "fabric_loading", "composite"}, 60, 3  # programs; seconds for a command, and for one of those
project, programs, scratch = (Path(argument).resolve() for argument in sys.argv[1:])
shutil.rmtree(scratch, ignore_errors=True)
(scratch / "build" / "release").mkdir(parents=True)
(scratch / "build" / "release" / "bin").symlink_to(programs)
(scratch / "examples").symlink_to(project / "examples")
kinds = json.loads((project / "CMakePresets.json").read_text()).values()
presets = {one["name"] for kind in kinds if isinstance(kind, list) for one in kind}
built = {path.name for path in programs.iterdir()}
targets = {path.name for path in (project / "examples").iterdir() if path.is_dir()} | {"fibrant_python"}
problems, unfinished, counts = [], set(), {"run": 0, "stopped": 0, "left out": 0}


def run(command, where):
    """Runs one command of a page."""
    arguments = shlex.split(command)
    if not Path(arguments[0]).name in built or any(
            f"out/{name}/" in argument for name in unfinished for argument in arguments):
        counts["left out"] += 1
        return print(f"left out: {command}")
    output = arguments[arguments.index("--output") + 1] if "--output" in arguments else ""
    child = subprocess.Popen(["sh", "-c", "exec " + command], cwd=scratch, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        said = child.communicate(timeout=ENOUGH if Path(arguments[0]).name in LONG else PATIENCE)[0]
        counts["run"] += 1
        if child.returncode != 0:
            problems.append(f"{where}: {command}\n  ends with {child.returncode}: {said[-400:]}")
    except subprocess.TimeoutExpired:
        child.send_signal(signal.SIGTERM)
        said = child.communicate()[0]
        counts["stopped"] += 1
        unfinished.add(Path(output).name)
        if child.returncode not in (0, 128 + signal.SIGTERM, -signal.SIGTERM):
            problems.append(f"{where}: {command}\n  ends with {child.returncode} when it is stopped: {said[-400:]}")


pages = [project / "README.md", *sorted((project / "docs" / "tutorials").glob("*.md")), *sorted((project / "docs" / "how-to").glob("*.md"))]
for page in pages:
    name, before = page.relative_to(project), ""
    for block in re.finditer(r"(?P<before>[^\n]*)\n+```(?P<kind>\w+)\n(?P<text>.*?)^```", page.read_text(), re.S | re.M):
        kind, text = block["kind"], block["text"]
        try:
            if kind == "python":
                ast.parse(text)
            if kind == "toml":
                tomllib.loads(text)
        except (SyntaxError, tomllib.TOMLDecodeError) as error:
            problems.append(f"{name}: a block of {kind} cannot be read: {error}")
        if kind == "toml" and (saved := re.search(r"[Ss]ave this as `([\w.]+)`", block["before"])):
            (scratch / saved[1]).write_text(text)
        if kind != "sh":
            continue
        lines = text.replace("\\\n", " ").split("\n")
        for line in (part.strip() for line in lines for part in line.split("&&")):
            problems += [f"{name}: there is no preset {preset}" for preset in re.findall(r"--preset (\w+)", line) if preset not in presets]
            if named := re.search(r"--target ([\w ]+)", line):
                problems += [f"{name}: there is no target {target}" for target in named[1].split()
                             if target.removesuffix("_mpi") not in targets]
            if line.startswith("build/release/bin/") and not line.endswith("&"):
                run(line, name)
print(", ".join(f"{number} {what}" for what, number in counts.items()))
if counts["run"] + counts["stopped"] + counts["left out"] < 10:
    problems.append("fewer than ten commands were found: the pages are read wrongly")
print("\n".join(problems))
sys.exit(1 if problems else 0)
