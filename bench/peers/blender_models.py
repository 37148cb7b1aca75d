# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts parish_church, dome_on_drum and colonnade for Blender, by its exact booleans.

usage: MODEL=parish_church blender -b --factory-startup -P blender_models.py
(writes blender.stl, tells the volume)
"""
import os
from math import cos, pi, radians, sin

import bmesh
import bpy
from mathutils import Matrix, Vector


class Shape:
    """Vertices and faces, before they become an object."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces

    def __add__(self, other):
        shift = len(self.vertices)
        return Shape(self.vertices + other.vertices,
                     self.faces + [[i + shift for i in face] for face in other.faces])

    def moved(self, matrix):
        return Shape([tuple(matrix @ Vector(v)) for v in self.vertices], self.faces)


def joined(shapes):
    return sum(shapes, Shape([], []))


def prism(outline, height, place=Matrix()):
    n = len(outline)
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return Shape([(x, y, z) for z in (0, height) for x, y in outline],
                 [list(range(n))[::-1], list(range(n, 2 * n))] + sides).moved(place)


def box(x, y, z, a, b, c):
    return prism([(0, 0), (a, 0), (a, b), (0, b)], c, Matrix.Translation((x, y, z)))


def revolved(profile, n):
    """Of (radius, z) from below upward; a radius of zero is a point."""
    vertices, rings = [], []
    for r, z in profile:
        count = n if r else 1
        rings.append([len(vertices) + i % count for i in range(n + 1)])
        vertices += [(r * cos(2 * pi * i / n), r * sin(2 * pi * i / n), z) for i in range(count)]
    faces = [rings[0][:n][::-1]] + ([rings[-1][:n]] if profile[-1][0] else [])
    for low, high in zip(rings, rings[1:]):
        for i in range(n):
            face = [low[i], low[i + 1], high[i + 1], high[i]]
            faces.append(face if high[i] != high[i + 1] else face[:3])
    return Shape(vertices, faces)


def cylinder(radius, low, high, n):
    return revolved([(radius, low), (radius, high)], n)


def sphere(radius, z, n):
    """Its rings lie half a step off the poles, as OpenSCAD's do."""
    turns = [2 * pi / n * (i + 0.5) for i in range(n // 2)]
    return revolved([(radius * sin(t), z - radius * cos(t)) for t in turns], n)


def around(shape, count):
    return joined(shape.moved(Matrix.Rotation(radians(360 / count * i), 4, "Z"))
                  for i in range(count))


class Solid:
    """An object, and what is united with it and cut from it, one after the other."""

    def __init__(self, shape):
        self.object = self.object_of(shape)

    @staticmethod
    def object_of(shape):
        mesh = bpy.data.meshes.new("mesh")
        mesh.from_pydata(shape.vertices, [], shape.faces)
        made = bpy.data.objects.new("object", mesh)
        bpy.context.collection.objects.link(made)
        return made

    def combine(self, operation, shape):
        other = self.object_of(shape)
        modifier = self.object.modifiers.new("boolean", "BOOLEAN")
        modifier.object, modifier.operation, modifier.solver = other, operation, "EXACT"
        evaluated = self.object.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh = bpy.data.meshes.new_from_object(evaluated)
        self.object.modifiers.clear()
        self.object.data = mesh
        bpy.data.objects.remove(other)
        return self

    def unite(self, shape):
        return self.combine("UNION", shape)

    def cut(self, shape):
        return self.combine("DIFFERENCE", shape)

    def take_shape(self):
        mesh = self.object.data
        shape = Shape([tuple(v.co) for v in mesh.vertices],
                      [list(face.vertices) for face in mesh.polygons])
        bpy.data.objects.remove(self.object)
        return shape


def parish_church():
    roof = prism([(-0.5, 0), (13.5, 0), (6.5, 6)], 60)
    upright = Matrix(((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 8), (0, 0, 0, 1)))
    return [Solid(box(0, 0, 0, 60, 13, 8))
            .unite(joined(box(7 * i, y, 0, 0.7, 2, 7) for i in range(9) for y in (-1, 12)))
            .unite(box(-8, 2.5, 0, 9, 8, 20))
            .cut(joined(box(1.2 + 1.9 * i, y, 2, 0.8, 2, 3)
                        for i in range(30) for y in (-0.5, 11.5)))
            .unite(roof.moved(upright)).object]


def dome_on_drum():
    dome = (Solid(sphere(10, 8, 128)).cut(sphere(9.5, 8, 128))
            .cut(box(-20, -20, -32, 40, 40, 40)).cut(cylinder(1.5, 8, 38, 32)).take_shape())
    lantern = Solid(cylinder(2, 17.5, 21.5, 32)).cut(cylinder(1.5, 16.5, 20.5, 32)).take_shape()
    head = [(0.5 * cos(pi * i / 16), 3 + 0.5 * sin(pi * i / 16)) for i in range(17)]
    outward = Matrix(((0, 0, 1, 8), (1, 0, 0, 0), (0, 1, 0, 2), (0, 0, 0, 1)))
    window = prism([(-0.5, 0), (0.5, 0)] + head, 4, outward)
    return [Solid(cylinder(10.5, 0, 8, 128)).cut(cylinder(9.5, -1, 9, 128))
            .cut(around(window, 24)).unite(dome).unite(lantern)
            .unite(revolved([(2.2, 21.5), (0, 23.5)], 32)).object]


def colonnade():
    profile = [(0.7, 0), (0.7, 0.2), (0.6, 0.3), (0.5, 0.4), (0.48, 2.5), (0.42, 5), (0.5, 5.2),
               (0.65, 5.5), (0.65, 5.7)]
    flute = cylinder(0.045, 0.6, 4.8, 12).moved(Matrix.Translation((0.51, 0, 0)))
    column = Solid(revolved(profile, 64)).cut(around(flute, 24)).object
    columns = []
    for x, y in ([(2 * i, y) for i in range(70) for y in (0, 62)] +
                 [(x, 2 * i) for i in range(1, 31) for x in (0, 138)]):
        copy = bpy.data.objects.new("column", column.data)
        copy.location = (x, y, 0)
        bpy.context.collection.objects.link(copy)
        columns.append(copy)
    bpy.data.objects.remove(column)
    return columns


def volume(solid):
    mesh = bmesh.new()
    mesh.from_mesh(solid.data)
    return mesh.calc_volume()


bpy.ops.wm.read_factory_settings(use_empty=True)
solids = {f.__name__: f for f in (parish_church, dome_on_drum, colonnade)}[os.environ["MODEL"]]()
bpy.ops.export_mesh.stl(filepath="blender.stl")
print(f"{volume(solids[0]) * len(solids):.4f} m3")
