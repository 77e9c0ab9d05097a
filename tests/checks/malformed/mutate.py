# SPDX-License-Identifier: MIT
"""Scenes that are changed at random: a program refuses each by file and key, or begins to work on it. It never crashes, and
never waits without a sign of life.

usage: mutate.py PROGRAM SCENE SCRATCH_FOLDER MUTANTS [FIRST] [SECONDS]
The scene files beside SCENE take part as well. The same numbers give the same mutants. SECONDS: how long one may work before it is
ended."""
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import time

WAIT = 20.0  # seconds until results must be begun, on a machine that is busy with other things
CPP = re.compile(r"::|\bstd\b|basic_|fibrant|_param|bad_alloc|what\(\)|terminate|[A-Z][a-z]+[A-Z][a-z]+")
ODD = ["\u00e9", "\u200b", "\u202e", "\U0001f9f6", "\ufeff", "\u0663", "\u2212", "\u00a0", "\u2028"]


def entries(lines):
    """Lines that give a key: number, key, value, and what stands behind the value."""
    found = []
    for k, line in enumerate(lines):
        match = re.match(rb"^(\s*[\w.]+\s*=\s*)(\"[^\"]*\"|'[^']*'|\[.*\]|\{.*\}|[^#\s]+)(.*)$", line)
        if match:
            found.append((k, match.group(1), match.group(2), match.group(3)))
    return found


def number(value):
    try:
        return float(value)
    except ValueError:
        return None


def mutant(text, chance):
    """What was done, and the scene after it."""
    lines = text.split(b"\n")
    keys = entries(lines)
    numbers = [entry for entry in keys if number(entry[2]) is not None]
    kinds = ["delete", "duplicate", "swap", "type", "cut", "byte", "odd", "header", "move"]
    kinds += 2 * ["sign", "larger", "smaller", "special", "whole"] if numbers else []
    kind = chance.choice(kinds)
    k, begin, value, rest = chance.choice(keys)
    if kind == "delete":
        del lines[k]
    elif kind == "duplicate":
        lines.insert(chance.randrange(k, len(lines)), lines[k])
    elif kind == "swap":
        other = chance.choice(keys)
        lines[k], lines[other[0]] = begin + other[2] + rest, other[1] + value + other[3]
    elif kind == "move":
        moved = lines.pop(k)
        lines.insert(chance.randrange(len(lines) + 1), moved)
    elif kind == "type":
        new = chance.choice([b"true", b'"text"', b"[1, 2]", b"{a = 1}", b"1979-05-27", b"3", b"0.5", b'["a"]', b"[[]]", b"''", b"[]", b'""'])
        lines[k] = begin + new + rest
    elif kind == "header":
        titles = [n for n, line in enumerate(lines) if line.startswith(b"[")]
        n = chance.choice(titles)
        lines[n] = chance.choice([b"", b"[" + lines[n] + b"]", lines[n][:-1], lines[n].upper(), lines[n].replace(b"]", b".more]")])
    elif kind == "cut":
        return kind, text[: chance.randrange(len(text))]
    elif kind == "byte":
        place = chance.randrange(len(text))
        return kind, text[:place] + bytes([chance.randrange(256)]) + text[place:]
    elif kind == "odd":
        place = chance.randrange(len(text))
        return kind, text[:place] + chance.choice(ODD).encode() + text[place:]
    else:
        k, begin, value, rest = chance.choice(numbers)
        if kind == "sign":
            new = value[1:] if value.startswith(b"-") else b"-" + value
        elif kind == "special":
            new = chance.choice([b"nan", b"inf", b"0", b"0.0", b"-0.0", b"1e308", b"5e-324", b"1e-30", b"1e30", b"2147483648"])
        else:
            factor = chance.choice({"larger": [1e6, 1e3, 10], "smaller": [1e-6, 1e-3, 0.1], "whole": [1, 2, 3]}[kind])
            made = number(value) * factor
            whole = re.fullmatch(rb"[+-]?\d+", value) is not None and made == int(made)
            new = (str(int(made)) if whole else repr(made)).encode()
        lines[k] = begin + new + rest
    return kind, b"\n".join(lines)


def limits():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def verdict(program, scene, out, seconds):
    """What is wrong with how the program takes the scene; None: nothing. And how it took it."""
    shutil.rmtree(out, ignore_errors=True)
    with open(scene.parent / "said", "w+b") as said:
        run = subprocess.Popen([program, scene, "--output", out, "--quiet", "--threads=1"], stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                               preexec_fn=limits)
        start = time.monotonic()
        begun = None
        while run.poll() is None:
            now = time.monotonic()
            if begun is None and (out / "parameters.toml").exists():
                begun = now
            if now > (start + WAIT if begun is None else begun + seconds):
                break
            time.sleep(0.01)
        ended = run.poll() is not None
        if not ended:
            run.kill()
        run.wait()
        said.seek(0)
        message = said.read().decode(errors="replace").strip()
    own = message.replace(str(scene), "SCENE").replace(str(scene.parent.parent), "").replace("ParaView", "").replace("TexGen", "")
    if CPP.search(own):
        return f"words of C++: {own}", "worked"
    if not ended:
        return (None if begun else "gave no sign of life"), "worked"
    if run.returncode in (0, 1):
        return None, "worked"
    if run.returncode != 2:
        return f"ended with status {run.returncode}: {own}", "worked"
    told = [line for line in own.split("\n") if "note:" not in line]
    if len(told) > 2:
        return f"says more than a line: {own}", "refused"
    if not re.search(r"SCENE(:\d+|: [^ ]*\w)", own):
        return f"does not name the file: {own}", "refused"
    if not re.search(r"SCENE:\d+:|[a-z]\w*\.[a-z]\w*|one of the sections|must be a section", own):
        return f"does not name the key: {own}", "refused"
    with open(scene.parent / "messages", "a", encoding="utf-8") as messages:
        messages.write(own + "\n")
    return None, "refused"


def main():
    program, scene, scratch, count = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), int(sys.argv[4])
    first = int(sys.argv[5]) if len(sys.argv) > 5 else 0
    seconds = float(sys.argv[6]) if len(sys.argv) > 6 else 2.0
    name = os.path.basename(program)
    shutil.rmtree(scratch, ignore_errors=True)
    for file in scene.parent.parent.glob("*/*"):  # scenes name other files from where they are
        if file.suffix in (".toml", ".csv", ".tg3"):
            (scratch / file.parent.name).mkdir(parents=True, exist_ok=True)
            shutil.copy(file, scratch / file.parent.name)
    scenes = sorted(scene.parent.glob("*.toml"))
    bad = 0
    took = {"refused": 0, "worked": 0}
    for k in range(first, first + count):
        chance = random.Random(f"{name} {k}")
        origin = chance.choice(scenes)
        kind, text = mutant(origin.read_bytes(), chance)
        changed = scratch / scene.parent.name / "mutant.toml"
        changed.write_bytes(text)
        wrong, how = verdict(os.path.abspath(program), changed.resolve(), (scratch / "results").resolve(), seconds)
        took[how] += 1
        if wrong:
            bad += 1
            kept = scratch / f"mutant_{k}.toml"
            kept.write_bytes(text)
            print(f"mutate: {name}: {kind} of {origin.name}, kept as {kept}: {wrong[:500]}")
    print(f"mutate: {name}: {bad} of {count} mutants are wrong; {took['refused']} refused, {took['worked']} worked on")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
