# SPDX-License-Identifier: MIT
"""Crimp and thickness of a plain weave against friction: python3 weave_friction.py [PICTURE.svg]

Settles a small fabric at each coefficient, and draws both against it.
"""
import sys

import fibrant
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

scene = {
    "fabric": {"pattern": "plain", "warp_tows": 3, "weft_tows": 3, "warp_spacing": 0.88, "overhang": 0.88, "elements": 20},
    "warp": {"fibres": 7, "real_fibres": 380, "real_diameter": 0.018, "aspect": 2.5},
    "material": {"young_modulus": 7300.0, "poisson_ratio": 0.3},
    "output": {"paraview": False, "pictures": False},
}
coefficients = [0.0, 0.1, 0.2, 0.4]
crimp, thickness = [], []
for mu in coefficients:
    run = fibrant.weave(scene, set={"contact.friction_coefficient": mu})
    if not run.sound:
        raise SystemExit(f"friction {mu}: {run.summary['reason'] or 'the audit is not clean'}")
    crimp.append(100.0 * run.summary["crimp_warp"])
    thickness.append(run.summary["thickness"])
    print(f"friction {mu}: crimp {crimp[-1]:.2f} %, thickness {thickness[-1]:.3f} mm")

figure, left = plt.subplots(figsize=(6, 4))
left.plot(coefficients, crimp, "o-", color="tab:blue")
left.set_xlabel("coefficient of friction")
left.set_ylabel("crimp of the warp [%]", color="tab:blue")
right = left.twinx()
right.plot(coefficients, thickness, "s--", color="tab:red")
right.set_ylabel("thickness [mm]", color="tab:red")
figure.tight_layout()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "weave_friction.svg")
