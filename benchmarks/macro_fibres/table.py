#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Table and plot of what benchmarks/macro_fibres/run.sh left: python3 table.py FOLDER"""
import json
import pathlib
import sys

here = pathlib.Path(__file__).parent
sys.path.append(str(here.parent))
from svg_plot import Plot, colours, rows  # noqa: E402

folder = pathlib.Path(sys.argv[1])


def summary(name):
    path = folder / name / "summary.json"
    return json.loads(path.read_text()) if path.exists() else None


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def of_load(name, stage, x, y, at):
    """What `y` of a load is where `x` is `at`; nothing if the load did not come so far."""
    path = folder / name / "increments.csv"
    if not path.exists():
        return None
    before = (0.0, None)
    for row in rows(path):
        if row["stage"] != stage:
            continue
        here, value = float(row[x]), float(row[y])
        if here >= at * (1 - 1e-9):
            start, from_there = before
            return value if from_there is None else from_there + (at - start) / (here - start) * (value - from_there)
        before = (here, value)
    return None


def figures(fibres):
    """What a fabric of so many fibres a tow is, by name."""
    told = summary(f"plain_{fibres}")
    # At crossings; the outermost tows have free edges.
    sections = [r for r in rows(folder / f"plain_{fibres}" / "sections.csv")
                if float(r["crossing"]).is_integer() and r["tow"] in ("1", "2") and r["crossing"] in ("1", "2")]
    found = {
        "crimp": 0.5 * (told["crimp_warp"] + told["crimp_weft"]),
        "thickness [mm]": told["thickness"],
        "width of a tow [mm]": mean(float(r["width"]) for r in sections),
        "thickness of a tow [mm]": mean(float(r["thickness"]) for r in sections),
        "volume fraction": mean(float(r["fibre_volume_fraction"]) for r in sections),
    }
    for strain in (0.002, 0.005):
        found[f"force at {100 * strain:g} % [N]"] = of_load(f"stretched_{fibres}", "stretch", "strain", "force", strain)
    for angle in (5, 10, 15, 19):
        found[f"force of shear at {angle} degrees [N]"] = of_load(f"sheared_{fibres}", "shear", "angle_deg", "force", angle)
    return found


counts = sorted(int(path.parent.name.split("_")[1]) for path in folder.glob("plain_*/summary.json"))
if not counts:
    sys.exit(f"{folder} has no fabric that has been settled")
all_figures = {n: figures(n) for n in counts}
print("| fibres a tow | " + " | ".join(str(n) for n in counts) + " |")
print("|---|" + "---|" * len(counts))
errors = {}
for name in all_figures[counts[0]]:
    known = [(n, all_figures[n][name]) for n in counts if all_figures[n][name] is not None]
    if not known:
        continue
    finest = known[-1][1]
    errors[name] = [(n, abs(value / finest - 1)) for n, value in known[:-1]]
    cells = []
    for n in counts:
        value = all_figures[n][name]
        off = "" if value is None or n == known[-1][0] else f" ({100 * (value / finest - 1):+.1f} %)"
        cells.append("-" if value is None else f"{value:.4g}{off}")
    print(f"| {name} | " + " | ".join(cells) + " |")
for title, part in (("settled: increments, Newton, linear iterations", "plain"), ("stretched", "stretched"),
                    ("sheared", "sheared")):
    told = {n: summary(f"{part}_{n}") for n in counts}
    if any(told.values()):
        print(f"| {title} | " + " | ".join(
            "-" if not t else f"{t['increments']}, {t['newton_iterations']}, {t['linear_iterations']}" +
            ("" if t["converged"] and t["audit_clean"] else " **not clean**") for t in told.values()) + " |")
told = {n: summary(f"plain_{n}") for n in counts}
print("| settled: unknowns, processor time [s], memory [MB] | " + " | ".join(
    f"{t['dofs']:,}, {t['cpu_seconds']:.0f}, {t['peak_memory_bytes'] / 1e6:.0f}" for t in told.values()) + " |")
print("| least gap over the radius; energy missed over the work | " + " | ".join(
    f"{t['least_gap_over_radius']:.4f}; {t['energy_error_over_work']:.1e}" for t in told.values()) + " |")

plot = Plot("what macro-fibres miss of the finest", "fibres a tow", "relative difference", (4, 500), (1e-4, 1), True, True)
for k, (name, points) in enumerate((n, p) for n, p in errors.items() if n in
                                   ("crimp", "thickness [mm]", "width of a tow [mm]", "volume fraction",
                                    "force at 0.5 % [N]", "force of shear at 15 degrees [N]")):
    shown = [(n, max(error, 1e-4)) for n, error in points]
    plot.line(shown, colours[k], name)
    plot.points(shown, colours[k])
plot.write(folder / "macro_fibres.svg", keys_at="bottom")
