# SPDX-License-Identifier: MIT
# Two crossed layers of eight fibres with friction, in Yade (Debian's yade): pressed into each other, then dragged across each other.
# Prints a CSV line each time the fibres are at rest. yade_bench.cpp has the same scene and starts this script:
# usage: yade -n -x -j1 yade_layers.py ELEMENTS PERIODS PRESSED DRAGGED_X DRAGGED_Y FRICTION
# PERIODS: of a fibre's lowest bending mode, over which the layers are moved, once for each way. Lengths in mm, forces in N.
import math
import sys
import time

from yade.gridpfacet import *

elements = int(sys.argv[1])
periods, pressed, dragged_x, dragged_y, friction = [float(a) for a in sys.argv[2:7]]
radius, length, pitch, young, density = 0.0201, 1.2, 0.12, 7300.0, 1.0

O.engines = [
    ForceResetter(),
    # Pairs within a layer are left out. Elements should be longer than a diameter all the same: docs/evidence/accuracy.md.
    InsertionSortCollider([Bo1_GridConnection_Aabb()], verletDist=0.5 * radius, avoidSelfInteractionMask=6),
    InteractionLoop(
        [Ig2_GridNode_GridNode_GridNodeGeom6D(), Ig2_GridConnection_GridConnection_GridCoGridCoGeom()],
        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True, setCohesionOnNewContacts=False), Ip2_FrictMat_FrictMat_FrictPhys()],
        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(), Law2_GridCoGridCoGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(gravity=(0, 0, 0), damping=0.2, label='newton'),
]
angle = math.atan(friction)
O.materials.append(CohFrictMat(young=young, poisson=0.3, density=density, frictionAngle=angle, normalCohesion=1e20, shearCohesion=1e20, momentRotationLaw=True, label='inside'))
O.materials.append(FrictMat(young=young, poisson=0.3, density=density, frictionAngle=angle, label='surface'))

ends = []  # of the upper layer
for upper in (False, True):
    for k in range(8):
        aside = (k - 3.5) * pitch
        nodes = []
        for n in range(elements + 1):
            along = -0.5 * length + length * n / elements
            place = (along, aside, 2.0 * radius) if upper else (aside, along, 0.0)
            nodes.append(O.bodies.append(gridNode(place, radius, wire=False, fixed=False, material='inside')))
        for n in range(elements):
            O.bodies.append(gridConnection(nodes[n], nodes[n + 1], radius, material='surface', mask=5 if upper else 3))
        for node in (nodes[0], nodes[-1]):
            O.bodies[node].state.blockedDOFs = 'xyzXYZ'
            O.bodies[node].state.vel = O.bodies[node].state.angVel = Vector3(0, 0, 0)
        if upper:
            ends += [nodes[0], nodes[-1]]

# Both the stretch and the turning of an element go at some 2 waves a length.
wave = math.sqrt(young / density)
O.dt = 0.3 * (length / elements) / wave
period = 2.0 * math.pi / (22.373 * 0.5 * radius * wave / length**2)
lines, force = set(ends), Vector3(0, 0, 0)


def move(way):
    """Moves the upper ends by a way that starts and ends smoothly, then lets all come to rest."""
    steps = int(periods * period / O.dt)
    time_of_move = steps * O.dt
    chunk = 20  # of steps a velocity
    for s in range(0, steps, chunk):
        speed = (1.0 - math.cos(2.0 * math.pi * (s + 0.5 * chunk) / steps)) / time_of_move
        for node in ends:
            O.bodies[node].state.vel = way * speed
        O.run(min(chunk, steps - s), True)
    for node in ends:
        O.bodies[node].state.vel = Vector3(0, 0, 0)
    O.run(int(4 * period / O.dt), True)


def report(name, start):
    sums = []
    for k in range(10):  # what vibrates about its mean
        O.run(int(0.1 * period / O.dt), True)
        sums.append(sum((O.forces.f(node) for node in ends), Vector3(0, 0, 0)))
    mean = sum(sums, Vector3(0, 0, 0)) / len(sums)
    contacts = [i for i in O.interactions if i.isReal and isinstance(O.bodies[i.id1].shape, GridConnection)]
    active = [i for i in contacts if i.phys.normalForce.norm() > 0]
    reactions = sum(i.phys.normalForce.norm() for i in active)
    deepest = max([i.geom.penetrationDepth for i in active] + [0.0])
    swing = max((s - mean).norm() for s in sums) / mean.norm()
    print("layers,%s,%d,%g,%.6e,%.6e,%.6e,%d,%.6e,%.2e,%.1e,%.3f" % (name, elements, periods, -mean[0], -mean[1], mean[2], len(active), reactions, deepest / radius, swing, time.process_time() - start))
    sys.stdout.flush()


begin = time.process_time()
move(Vector3(0, 0, -pressed * radius))
report("pressed", begin)
move(Vector3(dragged_x * radius, dragged_y * radius, 0))
report("dragged", begin)
