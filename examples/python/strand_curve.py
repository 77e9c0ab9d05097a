# SPDX-License-Identifier: MIT
"""Force and torque of a strand of seven wires that is stretched: python3 strand_curve.py [PICTURE.svg]"""
import pathlib
import sys

import fibrant
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).parent
run = fibrant.strand(here.parent / "strand" / "strand.toml", set={"output.paraview": False})
if not run.sound:
    raise SystemExit(run.summary["reason"] or "the audit is not clean")
curve = run.tables["increments"]

figure, left = plt.subplots(figsize=(6, 4))
left.plot(100.0 * curve["strain"], curve["force"], "o-", color="tab:blue")
left.set_xlabel("strain [%]")
left.set_ylabel("force [N]", color="tab:blue")
right = left.twinx()
right.plot(100.0 * curve["strain"], curve["torque"], "s--", color="tab:red")
right.set_ylabel("torque [N mm]", color="tab:red")
figure.tight_layout()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "strand_curve.svg")
