#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Damaged checkpoints: each is refused in one line that names the file, or, where its sum is right and the damage is a number
that may be there, the run goes on. Never a crash, a hang or a memory balloon.
usage: damaged.py <the program> <scene file> <scratch folder> <how many> [--unlimited] [--set section.key=value]..."""
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time

program, scene, out, many = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
more = sys.argv[5:]
unlimited = "--unlimited" in more  # sanitizers take terabytes of addresses
more = [word for word in more if word != "--unlimited"]
limit = 4 << 30
patience = 60  # seconds until a run that goes on is told to stop, and as much again until it hangs
name = os.path.basename(program)


def fail(text):
    sys.exit(f"damaged: {name}: {text}")


def confined():
    if not unlimited:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def start(folder):
    return subprocess.Popen([program, scene, "--output", folder, "--quiet", "--resume", *more], stderr=subprocess.PIPE,
                            text=True, errors="replace", preexec_fn=confined)


def fnv(data):
    total = 14695981039346656037
    for byte in data:
        total = ((total ^ byte) * 1099511628211) & 0xFFFFFFFFFFFFFFFF
    return total


# A checkpoint from within the run: it is told to stop once there is one.
shutil.rmtree(out, ignore_errors=True)
os.makedirs(out)
real = os.path.join(out, "real")
run = start(real)
while run.poll() is None and not os.path.exists(os.path.join(real, "checkpoint.bin")):
    time.sleep(0.02)
time.sleep(0.2)
run.send_signal(signal.SIGTERM)
run.communicate()
if run.returncode not in (0, 143):
    fail(f"the run itself ended with status {run.returncode}")
with open(os.path.join(real, "checkpoint.bin"), "rb") as file:
    whole = file.read()
body = whole[:-8]
if struct.unpack("<Q", whole[-8:])[0] != fnv(body):
    fail("its sum is another one than here")


def word_at(k):
    return struct.unpack_from("<Q", body, k)[0]


# Format, scene, four identities and the state, as state_file.hpp and stored_state.hpp write them.
text = 8 + word_at(0)
identities = text + 8 + word_at(text)
state = identities + 32
after = state + 8 + 8 * word_at(state)
chance = random.Random(1)


def put(at, form, value):
    changed = bytearray(body)
    struct.pack_into(form, changed, at, value)
    return bytes(changed)


def somewhere(size=8):
    # Half of the places are where counts and zones begin.
    if chance.random() < 0.5:
        return chance.randrange(after, min(after + 600, len(body) - size))
    return chance.randrange(state, len(body) - size)


def flipped(data):
    changed = bytearray(data)
    changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def swapped(data):
    size = min(64, len(data) // 4)
    first = chance.randrange(len(data) // 2 - size)
    second = chance.randrange(len(data) // 2, len(data) - size)
    changed = bytearray(data)
    changed[first:first + size], changed[second:second + size] = data[second:second + size], data[first:first + size]
    return bytes(changed)


def zeroed(data):
    at = chance.randrange(len(data) - 64)
    return data[:at] + bytes(64) + data[at + 64:]


def shortened(data):
    return data[:chance.randrange(len(data))]


huge = [2**64 - 1, 2**63 - 1, 2**61, 2**40, 2**32]
bare = [("a bit flipped", flipped), ("shortened", shortened), ("blocks swapped", swapped), ("zeroed", zeroed),
        ("nothing left", lambda data: b"")]
summed = [("a bit flipped", lambda: flipped(body)), ("shortened", lambda: shortened(body)),
          ("blocks swapped", lambda: swapped(body)), ("zeroed", lambda: zeroed(body)),
          ("a huge count", lambda: put(chance.choice([0, text, state]), "<Q", chance.choice(huge))),
          ("a huge number", lambda: put(somewhere(), "<Q", chance.choice(huge))),
          ("not a number", lambda: put(somewhere(), "<d", float("nan"))), ("infinite", lambda: put(somewhere(), "<d", float("inf"))),
          ("an index below", lambda: put(somewhere(4), "<i", -chance.randrange(1, 1000))),
          ("an index above", lambda: put(somewhere(4), "<i", chance.randrange(1 << 20, 1 << 31))),
          ("a state that is not a number", lambda: put(state + 8 + 8 * chance.randrange(word_at(state)), "<d", float("nan"))),
          ("bytes after its end", lambda: body + bytes(8)), ("a byte of ones", lambda: put(somewhere(1), "<B", 255))]
refused = went_on = 0
faults = []
for k in range(many):
    if k % 4 == 0:
        kind, damage = bare[(k // 4) % len(bare)]
        data = damage(whole)
        if data == whole:
            continue
    else:
        kind, damage = summed[(k - k // 4 - 1) % len(summed)]
        data = damage()
        data, kind = data + struct.pack("<Q", fnv(data)), kind + ", its sum made right"
    folder = os.path.join(out, "damaged")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(real, folder)
    with open(os.path.join(folder, "checkpoint.bin"), "wb") as file:
        file.write(data)
    run = start(folder)
    try:
        _, message = run.communicate(timeout=patience)
    except subprocess.TimeoutExpired:
        run.send_signal(signal.SIGTERM)
        try:
            _, message = run.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            run.kill()
            _, message = run.communicate()
    lines = message.strip().splitlines()
    if run.returncode == 2 and len(lines) == 1 and "checkpoint.bin" in lines[0]:
        refused += 1
    elif run.returncode in (0, 1, 143) and k % 4 != 0 and "Sanitizer" not in message and "runtime error" not in message:
        went_on += 1
    else:
        shutil.copy(os.path.join(folder, "checkpoint.bin"), os.path.join(out, f"fault_{k}.bin"))
        faults.append(f"{k} ({kind}): status {run.returncode}: {message.strip()[:600]}")
print(f"damaged: {name}: {refused} refused, {went_on} went on, {len(faults)} faults")
if faults:
    fail("\n  ".join(["faults:", *faults]))
