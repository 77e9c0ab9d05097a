#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tables and plots of what benchmarks/validation/run.sh left: python3 plots.py FOLDER

Reads what is there, prints a table for each set, and writes FOLDER/<set>.svg. Needs nothing but Python.
"""
import math
import pathlib
import sys

here = pathlib.Path(__file__).parent
sys.path.append(str(here.parent))
from svg_plot import Plot, colours, rows  # noqa: E402

folder = pathlib.Path(sys.argv[1])


def straight_line(points):
    """Slope and its standard error of y over x."""
    n = len(points)
    mean_x, mean_y = (sum(p[k] for p in points) / n for k in (0, 1))
    xx = sum((x - mean_x) ** 2 for x, _ in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / xx
    rest = sum((y - mean_y - slope * (x - mean_x)) ** 2 for x, y in points)
    return slope, math.sqrt(rest / max(n - 2, 1) / xx)


def mean_and_deviation(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / max(len(values) - 1, 1))


# sigma of a knot of 2 n + 1 crossings: contact forces add up to sigma E I / (r^1/2 R^3/2) where r is small against R. The first
# two from the boundary-value problem of the braid (Audoly, Clauvelin, Neukirch 2007); each further turn of the braid adds 0.9745.
sigma = {3: 0.4923009, 5: 1.4668422, 7: 2.441369, 9: 3.415897}


def knots():
    """What friction adds to the pull of a knot, over mu times what the theory of loose knots has for its contact forces."""
    print("\nknots: crossings, r/R, F R^2/EI without friction (theory), sum of contact forces r^1/2 R^3/2 / EI (sigma), W R/EI,"
          " what friction adds over mu P")
    found = []
    for path in sorted(folder.glob("knot_*/increments.csv")):
        crossings, radius = (int(text) for text in path.parent.name.split("_")[1:3])
        table = rows(path)
        settled = [row for row in table if row["stage"] == "settle"][-1]
        drawn = [row for row in table if row["stage"] == "draw"]
        mu = knot_friction
        loop = float(settled["shortening"]) / (2 * math.pi)
        pull, pressed = float(settled["force"]), float(settled["contact_force"])
        ratios = []
        for row in drawn[-5:]:
            other = float(row["shortening"]) / (2 * math.pi)
            friction = float(row["force"]) - pull * (loop / other) ** 2
            ratios.append(friction / mu / float(row["contact_force"]))
        theory = 0.5 + 3 * sigma[crossings] / math.pi / math.sqrt(loop)
        by_contact = pressed * loop**1.5
        ratio = f"{sum(ratios) / len(ratios):.4f}" if ratios else "-"
        energy = float(settled["elastic_energy"]) * loop
        print(f"{crossings} | 1/{loop:.0f} | {pull * loop**2:.4f} ({theory:.4f}) | {by_contact:.3f} ({sigma[crossings]:.3f}) |",
              f"{energy:.4f} | {ratio}")
        found.append((crossings, loop, by_contact, energy))
    if not found:
        return
    # W = pi E I / R + 4 sigma E I r^1/2 / R^3/2 + ...
    plot = Plot("loose knots: sigma by their energy", "(r / R)^(1/2)", "(W R / E I - pi) / 4 (R / r)^(1/2)", (0, 0.12), (0, 4))
    for k, crossings in enumerate(sorted({f[0] for f in found})):
        plot.points([(0, sigma[crossings])], colours[k], f"{crossings} crossings: theory at r/R = 0", hollow=True)
        mine = sorted((math.sqrt(1 / f[1]), 0.25 * (f[3] - math.pi) * math.sqrt(f[1])) for f in found if f[0] == crossings)
        plot.points(mine, colours[k], "computed")
        if len(mine) == 2:
            (x0, y0), (x1, y1) = mine
            print(f"{crossings} crossings: a line through both meets r/R = 0 at {y0 - x0 * (y1 - y0) / (x1 - x0):.3f}")
        plot.line([(0, sigma[crossings])] + mine, colours[k], dash="4 3")
    plot.write(folder / "knots.svg")


knot_friction = 0.1  # of benchmarks/validation/knot.toml

philipse = 9.8  # contacts of a thin rod in random packings, measured (Wouterse, Luding, Philipse 2009)


def level_groups(name):
    """Rows at rest of levels.csv, by volume fraction."""
    path = folder / name / "levels.csv"
    groups = {}
    for row in rows(path) if path.exists() else []:
        if row["at_rest"] in ("1", "true"):
            groups.setdefault(round(float(row["volume_fraction"]), 4), []).append(row)
    return dict(sorted(groups.items()))


def mats():
    """Pressure and contacts over the volume fraction: fibres of all directions, and nearly in a plane."""
    kinds = [("mat_space", "all directions"), ("mat_plane", "within 20 degrees of a plane")]
    kinds = [(level_groups(name), name, title) for name, title in kinds]
    kinds = [kind for kind in kinds if kind[0]]
    if not kinds:
        return
    pressure = Plot("mats: pressure", "volume fraction", "pressure / modulus", (0.14, 0.4), (1e-7, 1e-2), True, True)
    length = "contacts of a length of fibre (30 diameters)"
    contact = Plot("mats: contacts", "volume fraction", length, (0.14, 0.4), (5, 40), True, True)
    contact.line([(0.14, philipse), (0.4, philipse)], "#888", "random packings of thin rods, measured: 9.8", "5 4")
    for k, (groups, name, title) in enumerate(kinds):
        print(f"\n{name}: volume fraction, seeds, pressure over modulus (factor of a seed), contacts, over those without bulk")
        means, contacts = [], []
        for fraction, group in groups.items():
            log, spread = mean_and_deviation([math.log(float(row["pressure_over_modulus"])) for row in group])
            number = sum(float(row["contacts_per_fibre"]) for row in group) / len(group)
            bare = sum(float(row["contacts_without_bulk"]) for row in group) / len(group)
            means.append((fraction, math.exp(log), math.exp(log - spread), math.exp(log + spread)))
            contacts.append((fraction, number))
            print(f"{fraction:.4f} | {len(group)} | {math.exp(log):.3g} ({math.exp(spread):.2f}) | {number:.2f} |",
                  f"{number / bare:.2f}")
        pressure.points(means, colours[k], title)
        pressure.line([m[:2] for m in means], colours[k])
        contact.points(contacts, colours[k], title)
        contact.line(contacts, colours[k])
        idle = {}  # contacts of the last level of each seed that carries nothing but its springs
        for row in rows(folder / name / "levels.csv"):
            if row["at_rest"] not in ("1", "true"):
                idle[row["seed"]] = float(row["contacts_per_fibre"])
        if idle and len(means) > 2:
            least = sum(idle.values()) / len(idle)
            over = [(math.log(number - least), math.log(mean[1])) for (_, number), mean in zip(contacts, means)]
            print("idle levels have %.2f contacts; power of the pressure over contacts beyond these" % least,
                  "%.2f +- %.2f" % straight_line(over))
        if len(means) > 2:
            last = [(math.log(x), math.log(y)) for x, y, *_ in means[-3:]]
            print("power of the last three levels: pressure %.2f +- %.2f" % straight_line(last))
            print("power of all levels: contacts %.2f +- %.2f" % straight_line([(math.log(x), math.log(y)) for x, y in contacts]))
            scatter = 100 * math.log(means[-1][3] / means[-1][1])
            print(f"scatter of seeds at the last level: pressure {scatter:.0f} %, thickness",
                  f"{scatter / straight_line(last)[0]:.1f} %")
    pressure.write(folder / "mats_pressure.svg", "bottom")
    contact.write(folder / "mats_contacts.svg")


def twist():
    """Friction of a fibre on a helix against the square of its turn."""
    path = folder / "closed.csv"
    if not path.exists():
        return
    plot = Plot("a fibre on a helix: friction against twist", "square of the turn theta [rad^2]", "log of the ratio of tensions",
                (0, 170), (0, 5))
    found = {}
    for row in rows(path):
        if row["form"] == "wound":
            mu, turns = (float(part.split()[-1]) for part in row["case"].split(";")[:2])
            found.setdefault(mu, []).append(((2 * math.pi * turns) ** 2, float(row["computed"]), float(row["expected"])))
    for k, (mu, points) in enumerate(sorted(found.items())):
        plot.line([(0, 0)] + [(x, e) for x, _, e in points], colours[k], f"mu theta^2 rho / L, mu = {mu:g}", "5 4")
        plot.points([(x, y) for x, y, _ in points], colours[k], "computed")
        slope, error = straight_line([(x, y) for x, y, _ in points])
        print(f"\nwound, mu {mu:g}: slope of the log over theta^2 {slope:.5f} +- {error:.5f};",
              f"mu rho / L = {points[0][2] / points[0][0]:.5f}")
    if found:
        plot.write(folder / "twist.svg")


course_spacing = 2.12  # mm, of benchmarks/validation/knit.toml
conductor_length = 500.0  # mm, of benchmarks/validation/conductor.toml


def knits():
    """A plain knit that is pulled along its courses. What two samples differ by, of five courses and of three, is the force of
    two courses with neighbours on both sides: edges cancel."""
    curves = []
    for courses in (3, 5):
        path = folder / f"knit_{courses}" / "loading" / "increments.csv"
        if not path.exists():
            return
        curves.append([(float(row["strain"]), float(row["force"])) for row in rows(path) if row["stage"] == "load"])

    def at(curve, strain):
        for (x0, y0), (x1, y1) in zip(curve, curve[1:]):
            if x0 <= strain <= x1 and x1 > x0:
                return y0 + (y1 - y0) * (strain - x0) / (x1 - x0)
        return None

    data = here / "data" / "knits"
    measured = [row for row in rows(data / "strain_at_load.csv") if (row["fabric"], row["direction"]) == ("stockinette", "x")]
    measured = [tuple(float(row[key]) for key in ("strain_mean", "force_per_width_N_per_mm", "strain_sd")) for row in measured]
    periodic = [(float(row["strain_x"]), float(row["force_per_width_N_per_mm"]))
                for row in rows(data / "periodic_simulation_stockinette_x.csv") if row["force_per_width_N_per_mm"]]
    mine = []
    for strain, force in curves[1]:
        other = at(curves[0], strain)
        if other is not None:
            mine.append((strain, (force - other) / (2.0 * course_spacing)))
    print("\nknit, along the courses: strain, force per width computed, by the periodic simulation, ratio; measured")
    measured_curve = [m[:2] for m in measured]
    for strain in [0.05 * k for k in range(1, 20)]:
        values = [at(curve, strain) for curve in (mine, periodic, measured_curve)]
        if values[0] is not None and values[1] is not None:
            tested = "-" if values[2] is None else f"{values[2]:.4f}"
            print(f"{strain:.2f} | {values[0]:.4f} | {values[1]:.4f} | {values[0] / values[1]:.2f} | {tested}")
    plot = Plot("a plain knit of acrylic yarn, pulled along its courses", "strain", "force per width [N/mm]", (0, 1.0), (0, 0.4))
    plot.points([m[:2] for m in measured], colours[1], "measured (deviation of the strain 0.002 to 0.008)", hollow=True)
    plot.line([p for p in periodic if p[0] >= 0], colours[2], "the authors' simulation, periodic, no friction", "5 4")
    plot.line([p for p in mine if p[1] >= 0], colours[0], "computed, five courses less three")
    plot.write(folder / "knits.svg")


def conductor():
    """A conductor of 61 wires that is bent under tension, between its bounds: all wires stuck, all free."""
    data = here / "data" / "conductor"
    measured = [(float(row["curvature_1_per_m"]), float(row["moment_N_m"])) for row in rows(data / "bending_measured.csv")]
    layers = rows(data / "layers.csv")
    free = sum(float(row["sum_EI_N_m2"]) for row in layers)
    stuck = free + sum(float(row["sum_EA_y2_N_m2"]) for row in layers)
    plot = Plot("a conductor of 61 wires, bent under 40 kN", "curvature [1/m]", "moment [N m]", (0, 0.5), (0, 90))
    plot.points(measured, colours[1], "measured", hollow=True)
    found = False
    for k, path in enumerate(sorted(folder.glob("conductor*/increments.csv"))):
        curve = [(0.0, 0.0)] + [(math.radians(float(row["angle_deg"])) / conductor_length * 1e3, float(row["moment"]) * 1e-3)
                                for row in rows(path) if row["stage"] == "loading"]
        found = True
        plot.line(curve, colours[0 if k == 0 else 2], "computed" if k == 0 else "computed, wires that do not roll")
        print(f"\n{path.parent.name}: curvature [1/m], moment computed [N m], measured, ratio, tension [kN]")
        tensions = [float(row["tension"]) * 1e-3 for row in rows(path) if row["stage"] == "loading"]
        for x, y in measured:
            for (x0, y0), (x1, y1), tension in zip(curve, curve[1:], tensions):
                if x0 <= x <= x1 and x1 > x0:
                    own = y0 + (y1 - y0) * (x - x0) / (x1 - x0)
                    print(f"{x:.4f} | {own:.2f} | {y:.2f} | {own / y:.2f} | {tension:.1f}")
                    break
        (x0, y0), (x1, y1) = curve[-min(5, len(curve))], curve[-1]
        print(f"slope at the start {curve[1][1] / curve[1][0]:.0f}, at the end {(y1 - y0) / (x1 - x0):.1f} N m^2;",
              f"bounds {stuck:.0f} and {free:.1f}")
    if found:
        plot.line([(0.0, 0.0), (90.0 / stuck, 90.0)], colours[3], "all wires stuck", "5 4")
        plot.line([(0.0, 0.0), (0.5, 0.5 * free)], colours[4], "all wires free", "2 3")
        plot.write(folder / "conductor.svg", "middle")


for part in (knots, mats, twist, knits, conductor):
    part()
