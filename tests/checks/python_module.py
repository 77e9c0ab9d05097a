# SPDX-License-Identifier: MIT
"""The Python module: arrays look into the run, figures agree with those of the program, what is wrong is refused."""
import pathlib
import sys
import tempfile

import numpy as np

import fibrant


def refused(what, *words):
    try:
        what()
    except ValueError as error:
        missing = [word for word in words if word not in str(error)]
        assert not missing, f"'{error}' does not say {missing}"
    else:
        raise AssertionError(f"not refused: {words}")


def near(value, expected, relative):
    assert abs(value - expected) <= relative * abs(expected), f"{value} is not {expected}"


radius, spacing = 0.1, 1.0
scene = {
    "fabric": {"pattern": "plain", "warp_tows": 3, "weft_tows": 3, "warp_spacing": spacing, "overhang": spacing, "elements": 16},
    "warp": {"fibres": 1, "radius": radius, "inertia_factor": 0.1},
    "material": {"young_modulus": 1000.0, "poisson_ratio": 0.3},
    "contact": {"friction_coefficient": 0.1},
    "output": {"paraview": False, "pictures": False},
}
run = fibrant.weave(scene, threads=1)
assert run.sound and run.summary["converged"] and run.summary["wrong_crossings"] == 0
assert len(run.fibres) == run.summary["fibres"] == 6

fibre = run.fibres[0]
line = fibre.centreline
assert line.shape == (33, 3) and np.shares_memory(line, fibre.centreline) and not line.flags.writeable
assert fibre.semi_axes == (radius, radius) and not fibre.closed
# Sections stay of the size of those at rest.
near(np.linalg.norm(fibre.director_1, axis=1).max(), 1.0, 0.05)
# Crimp between the outermost crossings, by chords between nodes: shorter than the curve by (h kappa)^2 / 24 for chords
# of length h.
for number, (one, crimp) in enumerate(zip(run.fibres, run.tables["fibres"]["crimp"])):
    others = run.fibres[3:] if number < 3 else run.fibres[:3]
    axis = np.argmax(np.ptp(one.centreline, axis=0))
    places = [np.mean(other.centreline[:, axis]) for other in others]
    along = one.centreline[:, axis]
    at = np.concatenate([[min(places)], along[(along > min(places)) & (along < max(places))], [max(places)]])
    order = np.argsort(along)
    part = np.stack([np.interp(at, along[order], one.centreline[order, k]) for k in range(3)], axis=1)
    chord = np.linalg.norm(np.diff(part, axis=0), axis=1)
    lost = np.max(chord) ** 2 * np.max(one.curvature) ** 2 / 24.0
    over = chord.sum() / (max(places) - min(places)) - 1.0
    assert abs(over - crimp) <= 2.0 * lost, (over, crimp, lost)
    assert crimp > 8.0 * lost, "the bar is wider than what it holds"

contacts = run.contacts
pressed = contacts.reaction > 0.0
assert len(contacts) == contacts.gap.size == contacts.normal.shape[0] and pressed.any()
# Warps are fibres 0 to 2, wefts 3 to 5: normals at crossings are those of the fabric, one way and the other in turn.
assert np.all(np.abs(contacts.normal[pressed, 2]) > 0.9)
assert np.all((contacts.fibre_i[pressed] < 3) & (contacts.fibre_j[pressed] >= 3))
up = {(i, j): n > 0.0 for i, j, n in zip(contacts.fibre_i[pressed], contacts.fibre_j[pressed], contacts.normal[pressed, 2])}
assert len(up) == 9 and all((above == up[0, 3]) == ((i + j) % 2 == 1) for (i, j), above in up.items())
# The run may be gone, its arrays stay.
before = line.copy()
folder = run.folder
del run, fibre, contacts
assert np.array_equal(line, before)

# The same scene from a file, with a key replaced, gives the same bits; results stay where they are asked for.
with tempfile.TemporaryDirectory() as scratch:
    path = pathlib.Path(scratch) / "weave.toml"
    rest = fibrant._toml({**scene, "warp": {**scene["warp"], "radius": 0.2}})
    path.write_text(rest)
    replaced = {"warp.radius": radius}
    again = fibrant.weave(path, output=path.parent / "out", set=replaced, threads=1)
    assert np.array_equal(again.fibres[0].centreline, before)
    assert (path.parent / "out" / "report.html").exists()
    refused(lambda: fibrant.weave(path, output=path.parent / "out", set=replaced), "holds results of an earlier run")
    refused(lambda: fibrant.weave(path, set={"warp.radius": -1.0}), "weave.toml", "warp.radius", "-1")

refused(lambda: fibrant.weave({**scene, "warp": {"fibres": 1, "raduis": radius}}), "scene: warp.raduis", "one of the keys")
refused(lambda: fibrant.weave({**scene, "warp": {"fibres": None}}), "warp.fibres", "None")
refused(lambda: fibrant.weave(scene, threads=-1), "threads", "-1")
refused(lambda: fibrant.weave("no_such.toml"), "no_such.toml")
refused(lambda: fibrant.weave(scene, resume=True), "output must be given")
refused(lambda: fibrant.run("loom", scene), "loom", "weave")
assert "[warp]" in fibrant.keys("weave") and "radius" in fibrant.keys("weave")
print("the Python module holds", file=sys.stderr)
