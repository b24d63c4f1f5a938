"""Pictures of the section on surfaces and points."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import arc_places, box, circumcircle, meeting_points, min_circle, round_trip, seen_from


def solid():
    picture = Picture("A curve that cuts itself: where it winds around a place at least once is inside")
    limacon = [52 + 104j + 35 * (1 + 2 * math.cos(t)) * cmath.rect(1, t) for t in (math.tau * i / 72 for i in range(72))]
    picture.path(limacon, "solid", closed=True)
    eight = [248 + 104j + complex(56 * math.sin(t), 46 * math.sin(2 * t)) for t in (math.tau * i / 72 for i in range(72))]
    picture.path(eight[:37], "inside", closed=True)
    picture.path(eight, "surface", closed=True)
    for curve, first in ((limacon, 12), (eight, 9), (eight, 46)):
        way = curve[first + 1] - curve[first]
        picture.arrow(curve[first] - way / 1000, curve[first + 1], "surface")
    for at, label in ((71 + 100j, "2"), (120 + 100j, "1"), (276 + 100j, "1"), (220 + 100j, "-1"), (176 + 164j, "0")):
        picture.text(at, label, "note-term", "middle")
    picture.text(160 + 12j, "winding numbers; inside (grey): 1 or more", anchor="middle")
    return picture


def radius_and_diagonal():
    picture = Picture("The bounding radius of a solid and the diagonal of its bounding box")
    shape = [60 + 40j, 220 + 40j, 220 + 90j, 115 + 90j, 115 + 150j, 60 + 150j]
    center, radius = min_circle(shape)
    scale = 92 / radius
    middle = 150 + 100j
    shape = [middle + (p - center) * scale for p in shape]
    picture.circle(middle, 92, "circle")
    picture.path(shape, "solid", closed=True)
    left, right = min(p.real for p in shape), max(p.real for p in shape)
    bottom, top = min(p.imag for p in shape), max(p.imag for p in shape)
    picture.path(box(left, bottom, right, top), "dashed", closed=True)
    picture.arrow(complex(left, bottom), complex(right, top), "size-term", both=True)
    picture.text(complex(left, bottom) + 0.72 * complex(right - left, top - bottom) + 8 - 10j, "D", "note-term")
    tip = middle + cmath.rect(92, math.radians(78))
    picture.arrow(middle, tip, "size-term")
    picture.text(middle + 0.6 * (tip - middle) + 8, "R", "note-term")
    picture.dot(middle)
    picture.text(252 + 22j, "ball around it", "note-axis", "middle")
    return picture


def grid_of_triangles(picture, place, columns, rows, style):
    for i in range(columns):
        for j in range(rows):
            a, b, c, d = (place(x / columns, y / rows) for x, y in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            picture.path([a, b, c], style, closed=True)
            picture.path([a, c, d], style, closed=True)


def sides_of_box(project):
    """The three sides of a box that are seen, as maps from the unit square."""
    return {"top": lambda u, v: project(3 * u, 2 * v, 1.5), "front": lambda u, v: project(3 * u, 0, 1.5 * v),
            "side": lambda u, v: project(3, 2 * u, 1.5 * v)}


def cluster():
    picture = Picture("The triangles of one side of a box are a cluster; its points repel each other")
    sides = sides_of_box(seen_from(0.6, 0.5, 52, 58 + 62j))
    for name, style in (("front", "triangle"), ("side", "triangle"), ("top", "region")):
        grid_of_triangles(picture, sides[name], 3, 2, style)
    a, b = sides["top"](0.43, 0.5), sides["top"](0.57, 0.5)
    picture.arrow(a, sides["top"](0.25, 0.5))
    picture.arrow(b, sides["top"](0.75, 0.5))
    picture.dot(a), picture.dot(b)
    picture.text(18 + 172j, "one cluster", "note-term")
    picture.text(238 + 26j, "two others")
    return picture


def surface_points():
    picture = Picture("Surface points: even over the sides of a box, denser along its edges")
    sides = sides_of_box(seen_from(0.6, 0.5, 52, 58 + 62j))
    on_sides, on_edges = [], []
    for side, (columns, rows) in (("top", (8, 5)), ("front", (8, 4)), ("side", (5, 4))):
        place = sides[side]
        picture.path([place(u, v) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))], "solid", closed=True)
        for i in range(columns):
            for j in range(rows):
                on_sides.append(place((i + 0.75 - 0.5 * (j % 2)) / columns, (j + 0.5) / rows))
    for side, ways in (("top", ((0, 0, 1, 0), (1, 0, 1, 1), (0, 1, 1, 1), (0, 0, 0, 1))), ("front", ((0, 0, 1, 0), (0, 0, 0, 1), (1, 0, 1, 1))),
                       ("side", ((0, 0, 1, 0), (1, 0, 1, 1)))):
        for u, v, x, y in ways:
            a, b = sides[side](u, v), sides[side](x, y)
            count = max(round(abs(b - a) / 9), 4)
            on_edges += [a + (b - a) * (i + 0.5) / count for i in range(count)]
    picture.dots(on_sides, "dot-axis", 2)
    picture.dots(on_edges, "dot-term", 2)
    picture.text(18 + 172j, "on edges", "note-term")
    picture.text(250 + 30j, "on sides", "note-axis")
    return picture


def interior_surface():
    picture = Picture("Where a surface cuts itself, a part of it lies inside the solid: interior surface")
    a, b = (118 + 108j, 72), (202 + 108j, 72)
    top, bottom = meeting_points(a, b)
    angle_a, angle_b = cmath.phase(top - a[0]), cmath.phase(top - b[0])
    for center, radius in (a, b):
        picture.circle(center, radius, "inside")
    picture.path(arc_places(a[0], a[1], angle_a, math.tau - angle_a, 48), "surface")
    picture.path(arc_places(b[0], b[1], -angle_b, angle_b, 48), "surface")
    picture.path(arc_places(a[0], a[1], -angle_a, angle_a), "term")
    picture.path(arc_places(b[0], b[1], angle_b, math.tau - angle_b), "term")
    for at, label in ((85 + 104j, "1"), (160 + 104j, "2"), (235 + 104j, "1")):
        picture.text(at, label, anchor="middle")
    picture.text(160 + 14j, "interior surface: inside the solid", "note-term", "middle")
    return picture


PICTURES = {"solid": solid, "radius-and-diagonal": radius_and_diagonal, "cluster": cluster, "surface-points": surface_points,
            "interior-surface": interior_surface}
