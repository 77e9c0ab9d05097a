# SPDX-License-Identifier: MIT
"""fibrant: how fibres touch, from Python.

    import fibrant
    run = fibrant.weave("plain.toml", set={"warp.fibres": 7})
    run.summary["crimp_warp"], run.fibres[0].centreline, run.contacts.reaction

A scene is the path of a scene file, or a dict of dicts with the same sections and keys (`fibrant.keys("weave")` prints them).
"""
import json as _json
import os as _os
import pathlib as _pathlib
import tempfile as _tempfile

import numpy as _numpy

from . import native as _native
from .native import Contacts, Curve, Fibre, read_curves

__version__ = _native.version
__all__ = ["run", "weave", "textile", "fabric_loading", "strand", "keys", "read_curves", "Run", "Fibre", "Contacts", "Curve"]


class Run:
    """What a program has found. Arrays look into its memory: they are no copies, and cannot be written to.

    sound     whether the run converged and its audit is clean
    summary   dict of summary.json
    fibres    list of `Fibre`
    contacts  `Contacts`
    folder    path of all files that the program has written
    tables    dict of the CSV files in the folder: "increments" -> dict of columns
    """

    def __init__(self, end, folder, kept=None):
        self._end, self._kept = end, kept
        self.folder = _pathlib.Path(folder)
        self.sound = end.sound
        self.summary = _json.loads(end.summary)
        self.fibres = end.fibres
        self.contacts = end.contacts

    @property
    def tables(self):
        return {path.stem: _table(path) for path in sorted(self.folder.glob("*.csv"))}

    def __repr__(self):
        return f"<fibrant.Run: {len(self.fibres)} fibres, {'sound' if self.sound else 'NOT sound'}, in {self.folder}>"


def run(program, scene, *, output=None, set=None, threads=None, resume=False, overwrite=False, quiet=True):
    """Runs "weave", "textile", "fabric_loading" or "strand".

    scene      path of a scene file, or a dict of its sections
    output     folder of the results; left out: one that lives as long as the answer
    set        {"section.key": value}, in the place of what the scene says
    threads    number; left out: as solver.threads says
    resume     go on from the last accepted increment in `output`
    overwrite  begin anew in a folder that holds results
    quiet      print no progress

    Returns a `Run`. Raises ValueError where the scene is refused (its message names the key, the value and the bound),
    KeyboardInterrupt when the run is stopped by Ctrl-C: then `resume` goes on from the last increment.
    """
    if output is None and resume:
        raise ValueError("resume = True, but output must be given: it is the folder to go on in")
    kept = _tempfile.TemporaryDirectory(prefix="fibrant_") if output is None else None
    folder = kept.name if kept else _os.fspath(output)
    given = isinstance(scene, dict)
    replaced = [f"{key}={_value(value, key)}" for key, value in (set or {}).items()]
    end = _native.run(program, "scene" if given else _os.fspath(scene), _toml(scene) if given else None, replaced, folder,
                      "" if threads is None else str(threads), resume, overwrite, quiet)
    if end.stopped:
        raise KeyboardInterrupt
    return Run(end, folder, kept)


def weave(scene, **how):
    """Settles a woven fabric from flat tows. See `run`."""
    return run("weave", scene, **how)


def textile(scene, **how):
    """Settles a braid, weave, knit, rope, net or mail. See `run`."""
    return run("textile", scene, **how)


def fabric_loading(scene, **how):
    """Loads a fabric that `weave` has settled. See `run`."""
    return run("fabric_loading", scene, **how)


def strand(scene, **how):
    """Stretches and turns a strand of wires. See `run`."""
    return run("strand", scene, **how)


def keys(program):
    """The keys of a scene of a program, with units, bounds and defaults, as a text."""
    return _native.keys(program)


def _table(path):
    with open(path, encoding="utf-8") as file:
        names, *rows = [line.rstrip("\n").split(",") for line in file]
    return {name: _column(column) for name, column in zip(names, zip(*rows) if rows else [()] * len(names))}


def _column(texts):
    try:
        return _numpy.array([float(text) if text else float("nan") for text in texts])
    except ValueError:
        return _numpy.array(texts)


def _toml(scene, above=""):
    values = [f"{_name(key)} = {_value(value, above + str(key))}" for key, value in scene.items() if not isinstance(value, dict)]
    text = "".join(line + "\n" for line in values)
    for key, value in scene.items():
        if isinstance(value, dict):
            text += f"[{above}{_name(key)}]\n" + _toml(value, f"{above}{_name(key)}.")
    return text


def _name(key):
    if not isinstance(key, str):
        raise ValueError(f"scene: {key!r} is a key, but it must be a text")
    return key if key.isidentifier() else _json.dumps(key)


def _value(value, key):
    if isinstance(value, (bool, _numpy.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return _json.dumps(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(one, key) for one in value) + "]"
    if isinstance(value, (int, _numpy.integer)):
        return str(int(value))
    if isinstance(value, (float, _numpy.floating)):
        return repr(float(value))
    if isinstance(value, _os.PathLike):
        return _json.dumps(_os.fspath(value))
    raise ValueError(f"scene: {key} = {value!r}, but it must be a number, a text, True or False, or a list of texts")
