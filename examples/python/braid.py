# SPDX-License-Identifier: MIT
"""A flat braid: its yarns from above, and how hard they press: python3 braid.py [PICTURE.svg]"""
import pathlib
import sys

import fibrant
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).parent
run = fibrant.textile(here.parent / "textile" / "braid_flat.toml", set={"output.paraview": False})
if not run.sound:
    raise SystemExit(run.summary["reason"] or "the audit is not clean")

figure, axes = plt.subplots(2, 1, figsize=(8, 5), layout="constrained")
for number, fibre in enumerate(run.fibres):
    x, y, _ = fibre.centreline.T
    axes[0].plot(y, x, color=f"C{number % 10}")
contacts = run.contacts
pressed = contacts.reaction > 0.0
places = axes[0].scatter(*contacts.position[pressed, 1::-1].T, c=contacts.reaction[pressed], s=8, cmap="magma", zorder=3)
figure.colorbar(places, ax=axes[0], label="reaction [N]", orientation="horizontal", aspect=60)
axes[0].set_aspect("equal")
axes[0].set_xlabel("y [mm]"), axes[0].set_ylabel("x [mm]")
for number, fibre in enumerate(run.fibres):
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fibre.centreline, axis=0), axis=1))])
    axes[1].plot(arc, fibre.curvature, color=f"C{number % 10}", linewidth=1)
axes[1].set_xlabel("arc length [mm]"), axes[1].set_ylabel("curvature [1/mm]")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "braid.svg")
