"""Pictures of the section on collision detection, but for motion."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import arc_places, box


def no_maybe_yes():
    picture = Picture("No: spheres apart. Maybe: spheres meet. Yes: triangles meet")
    shape = [-20 - 16j, 24 - 12j, -6 + 24j]
    for k, (name, shift, turn) in enumerate((("no", 22 + 28j, 2.4), ("maybe", 14 + 19j, 2.4), ("yes", 8 + 12j, 2.9))):
        middle = 56 + 104 * k + 104j
        for center, angle in ((middle - shift, 0.2), (middle + shift, turn)):
            corners = [center + p * cmath.rect(1, angle) for p in shape]
            radius = max(abs(p - center) for p in corners)
            picture.circle(center, radius, "circle")
            picture.path(corners, "solid", closed=True)
        picture.text(middle.real + 178j, name, "note-term", "middle")
        picture.text(middle.real + 12j, ("spheres apart", "spheres meet", "triangles meet")[k], anchor="middle")
    return picture


def obb_node():
    picture = Picture("An OBB node: the part of a ball between two planes, and the oriented box around the same triangles")
    way = cmath.rect(1, math.radians(18))
    corners = [complex(*p) for p in ((-82, -14), (-52, 22), (-26, -18), (2, 16), (30, -22), (54, 18), (82, -6))]
    height, length, radius = (max(abs(p.imag) for p in corners), max(abs(p.real) for p in corners), max(abs(p) for p in corners))
    center = 158 + 96j
    side = math.asin(height / radius)
    slab = arc_places(0, radius, -side, side, 8) + arc_places(0, radius, math.pi - side, math.pi + side, 8)
    place = [center + p * way for p in slab]
    picture.circle(center, radius, "circle")
    picture.path(place, "region", closed=True)
    for sign in (1, -1):
        picture.line(center + complex(-118, sign * height) * way, center + complex(118, sign * height) * way, "term")
    picture.path([center + p * way for p in box(-length, -height, length, height)], "box", closed=True)
    for a, b, c in zip(corners, corners[1:], corners[2:]):
        picture.path([center + p * way for p in (a, b, c)], "triangle", closed=True)
    picture.text(158 + 158j, "ball", "note-axis", "middle")
    picture.text(34 + 92j, "planes", "note-term", "middle")
    picture.text(262 + 92j, "box", anchor="middle")
    return picture


def manifold():
    picture = Picture("A manifold: contact points of two bodies, with a normal and a depth")
    picture.path(box(14, 14, 306, 84), "solid", closed=True)
    turn = cmath.rect(1, math.radians(5))
    low = 108 + 64j
    body = [low + p * turn for p in (0, 112, 112 + 74j, 74j)]
    picture.path(body, "body", closed=True)
    points = [p + (q - p) * (84 - p.imag) / (q - p).imag for p, q in ((body[0], body[3]), (body[1], body[2]))]
    for point in points:
        picture.dot(point, "dot-term", 4.4)
    picture.arrow(164 + 84j, 164 + 132j, "size-term")
    picture.text(170 + 112j, "normal", "note-term")
    picture.line(body[0], body[0] - 62, "dashed")
    picture.arrow(complex(64, 84), complex(64, body[0].imag), "size-term", both=True)
    picture.text(56 + 70j, "depth", "note-term", "end")
    picture.text(160 + 34j, "contact points", "note-term", "middle")
    for point in points:
        picture.line(160 + 46j, point - 4j, "thin")
    picture.text(292 + 20j, "a", anchor="end")
    picture.text(116 + 122j, "b")
    return picture


PICTURES = {"no-maybe-yes": no_maybe_yes, "obb-node": obb_node, "manifold": manifold}
