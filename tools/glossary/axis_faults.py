"""Pictures of reconstructions of medial axes, and of how they miss the solid."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import arc_places, box, hull_of_disks


def envelope():
    picture = Picture("Vertices, edges and triangles of an axis stand for balls, cones and slabs; their union is the reconstruction")
    ball = [(50 + 100j, 30)]
    cone = [(122 + 74j, 16), (142 + 128j, 27)]
    slab = [(214 + 72j, 20), (284 + 80j, 14), (254 + 138j, 24)]
    for disks, kind in ((ball, "vertex: ball"), (cone, "edge: cone"), (slab, "triangle: slab")):
        picture.path(hull_of_disks(disks, 64), "region", closed=True)
        for center, radius in disks:
            picture.circle(center, radius, "circle")
        if len(disks) > 1:
            picture.path([center for center, _ in disks], "axis", closed=len(disks) > 2)
        for center, _ in disks:
            picture.dot(center, "dot-axis")
        middle = sum(center for center, _ in disks).real / len(disks)
        picture.text(complex(middle, 26), kind, anchor="middle")
    picture.text(160 + 178j, "envelope: boundary of the union", "note-term", "middle")
    return picture


def stadium(left, right, radius):
    return (arc_places(left, radius, math.pi / 2, 1.5 * math.pi) + arc_places(right, radius, -math.pi / 2, math.pi / 2))


def dent():
    picture = Picture("A dent: the boundary of the reconstruction lies deep in the solid, between sheets that do not meet")
    picture.path(box(12, 44, 308, 136), "solid", closed=True)
    radius, gap = 46, 86
    a, b = complex(160 - gap / 2, 90), complex(160 + gap / 2, 90)
    picture.path(stadium(58 + 90j, a, radius), "ball", closed=True)
    picture.path(stadium(b, 262 + 90j, radius), "ball", closed=True)
    picture.line(58 + 90j, a, "axis")
    picture.line(b, 262 + 90j, "axis")
    side = math.acos(gap / 2 / radius)  # where the two end balls meet
    picture.path(arc_places(a, radius, math.pi / 2, side), "term")
    picture.path(arc_places(b, radius, math.pi / 2, math.pi - side), "term")
    bottom = complex(160, 90 + radius * math.sin(side))
    picture.arrow(160 + 136j, bottom, "size-term", both=True)
    picture.dot(bottom, "dot-term", 4)
    picture.text(160 + 148j, "dent", "note-term", "middle")
    picture.text(168 + 104j, "depth", "note-term")
    picture.text(82 + 96j, "sheet", "note-axis", "middle")
    picture.text(234 + 96j, "sheet", "note-axis", "middle")
    picture.text(160 + 20j, "the sheets do not quite meet", anchor="middle")
    return picture


def coverage_and_protrusion():
    picture = Picture("Coverage error: how far the surface is from the reconstruction. Protrusion: how far that reaches out of the solid")
    picture.path(box(30, 44, 262, 136), "solid", closed=True)
    disks = [(98 + 90j, 62), (212 + 90j, 40)]
    picture.path(hull_of_disks(disks), "ball", closed=True)
    picture.line(disks[0][0], disks[1][0], "axis")
    for center, _ in disks:
        picture.dot(center, "dot-axis")
    top = disks[0][0] + 62j
    picture.arrow(complex(top.real, 136), top, "size-term", both=True)
    corner = 262 + 136j
    center, radius = disks[1]
    picture.arrow(center + radius * (corner - center) / abs(corner - center), corner, "size-term", both=True)
    picture.text(top + 6j, "protrusion", "note-term", "middle")
    picture.text(250 + 150j, "coverage error", "note-term", "middle")
    picture.text(160 + 14j, "solid and reconstruction", anchor="middle")
    return picture


PICTURES = {"envelope": envelope, "dent": dent, "coverage-and-protrusion": coverage_and_protrusion}
