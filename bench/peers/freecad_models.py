# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts parish_church, dome_on_drum and colonnade for FreeCAD, whose solids are exact.

usage: MODEL=parish_church freecadcmd freecad_models.py    (writes freecad.stl, tells the volume)
"""
import math
import os

import Mesh
import MeshPart
import Part
from FreeCAD import Vector

AXIS = Vector(0, 0, 0), Vector(0, 0, 1)


def box(x, y, z, *size):
    return Part.makeBox(*size, Vector(x, y, z))


def cylinder(radius, height, z, x=0):
    return Part.makeCylinder(radius, height, Vector(x, 0, z))


def polygon(*corners):
    return Part.Face(Part.makePolygon([Vector(*corner) for corner in corners + corners[:1]]))


def around(shape, count):
    """Copies of it about the z axis."""
    copies = [shape.copy() for _ in range(count)]
    for i, copy in enumerate(copies):
        copy.rotate(*AXIS, i * 360 / count)
    return copies


def meshed(shape, angle=2 * math.pi / 128):
    return MeshPart.meshFromShape(Shape=shape, LinearDeflection=0.05, AngularDeflection=angle,
                                  Relative=False)


def parish_church():
    blocks = [box(7 * i, y, 0, 0.7, 2, 7) for i in range(9) for y in (-1, 12)]
    windows = [box(1.2 + 1.9 * i, y, 2, 0.8, 2, 3) for i in range(30) for y in (-0.5, 11.5)]
    walls = box(0, 0, 0, 60, 13, 8).fuse(blocks + [box(-8, 2.5, 0, 9, 8, 20)]).cut(windows)
    roof = polygon((0, -0.5, 8), (0, 13.5, 8), (0, 6.5, 14)).extrude(Vector(60, 0, 0))
    return meshed(walls.fuse(roof))


def dome_on_drum():
    centre = Vector(0, 0, 8)
    dome = Part.makeSphere(10, centre).cut(
        [Part.makeSphere(9.5, centre), box(-20, -20, -32, 40, 40, 40), cylinder(1.5, 30, 8)])
    corners = [Vector(8, y, z) for y, z in ((-0.5, 5), (-0.5, 2), (0.5, 2), (0.5, 5))]
    head = Part.Arc(corners[3], Vector(8, 0, 5.5), corners[0]).toShape()
    outline = Part.Wire([*(Part.makeLine(a, b) for a, b in zip(corners, corners[1:])), head])
    window = Part.Face(outline).extrude(Vector(4, 0, 0))
    drum = cylinder(10.5, 8, 0).cut([cylinder(9.5, 10, -1)] + around(window, 24))
    lantern = cylinder(2, 4, 17.5).cut(cylinder(1.5, 4, 16.5))
    return meshed(drum.fuse([dome, lantern, Part.makeCone(2.2, 0, 2, Vector(0, 0, 21.5))]))


def colonnade():
    profile = ((0, 0), (0.7, 0), (0.7, 0.2), (0.6, 0.3), (0.5, 0.4), (0.48, 2.5), (0.42, 5),
               (0.5, 5.2), (0.65, 5.5), (0.65, 5.7), (0, 5.7))
    turned = polygon(*((x, 0, z) for x, z in profile)).revolve(*AXIS, 360)
    column = meshed(turned.cut(around(cylinder(0.045, 4.2, 0.6, x=0.51), 24)), angle=0.5)
    whole = Mesh.Mesh()
    for x, y in ([(2 * i, y) for i in range(70) for y in (0, 62)] +
                 [(x, 2 * i) for i in range(1, 31) for x in (0, 138)]):
        copy = column.copy()
        copy.translate(x, y, 0)
        whole.addMesh(copy)
    return whole


mesh = {f.__name__: f for f in (parish_church, dome_on_drum, colonnade)}[os.environ["MODEL"]]()
mesh.write("freecad.stl")
print(f"{mesh.Volume:.4f} m3")
