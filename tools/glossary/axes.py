"""Pictures of the section on medial axes: what an axis is and what it is made of."""
import math

from glossary.canvas import Picture
from glossary.plane import box, edges_between, is_inside, parabola, seen_from, voronoi_vertices


def axis_of_l(corner, arm, thickness):
    """The exact axis of an L with two equal arms: its lines, and its balls at the junction and along one arm."""
    t, reflex = thickness, complex(thickness, thickness)
    near = t * (2 - math.sqrt(2))  # where the ball touches both outer sides and the reflex corner
    bow = parabola(reflex, 0, near, t)
    straight = [complex(t, t / 2), complex(arm - t / 2, t / 2)]
    half = [[0j, complex(near, near)], bow + straight, [straight[1], complex(arm, 0)], [straight[1], complex(arm, t)]]
    lines = half + [[complex(p.imag, p.real) for p in line] for line in half[1:]]
    balls = [(complex(near, near), near), (bow[9], bow[9].imag), (complex(0.76 * arm, t / 2), t / 2)]
    return [[corner + p for p in line] for line in lines], [(corner + c, r) for c, r in balls]


def medial_axis():
    picture = Picture("The medial axis of an L: the centres of all balls that no other ball in the solid contains")
    corner, arm, t = 40 + 14j, 172, 84
    picture.path([corner + p for p in (0, arm, arm + t * 1j, t + t * 1j, t + arm * 1j, arm * 1j)], "solid", closed=True)
    lines, balls = axis_of_l(corner, arm, t)
    for center, radius in balls:
        picture.circle(center, radius, "ball")
    for line in lines:
        picture.path(line, "term")
    for center, _ in balls:
        picture.dot(center, "dot-axis")
    picture.text(140 + 160j, "medial axis", "note-term")
    picture.text(140 + 138j, "some of its balls", "note-axis")
    picture.text(140 + 116j, "solid")
    return picture


def raw_and_refined():
    picture = Picture("The raw axis is a part of a Voronoi diagram of points; the balls of the refined axis touch the surface itself")
    shape = box(16, 54, 146, 144)
    picture.path(shape, "solid", closed=True)
    spots = (0.07, 0.24, 0.42, 0.63, 0.79, 0.95)
    sites = [complex(16 + 130 * f, 54) for f in spots] + [complex(16 + 130 * ((f + 0.09) % 1), 144) for f in spots]
    sites += [complex(16, 54 + 90 * f) for f in (0.2, 0.46, 0.83)] + [complex(146, 54 + 90 * f) for f in (0.27, 0.6, 0.9)]
    vertices = [v for v in voronoi_vertices(sites) if is_inside(v[0], shape)]
    for a, b in edges_between(vertices):
        picture.line(a[0], b[0], "term")
    center, radius, _ = min(vertices, key=lambda v: abs(v[0] - 92 - 99j))
    picture.circle(center, radius, "ball")
    for site in sites:
        picture.dot(site, radius=2.4)
    picture.dot(center, "dot-axis")
    left, right, bottom, top = 174, 304, 54, 144
    picture.path(box(left, bottom, right, top), "solid", closed=True)
    half = (top - bottom) / 2
    ends = [complex(left + half, 99), complex(right - half, 99)]
    picture.circle(234 + 99j, half, "ball")
    for a, b in ((ends[0], ends[1]), (ends[0], complex(left, bottom)), (ends[0], complex(left, top)), (ends[1], complex(right, bottom)),
                 (ends[1], complex(right, top))):
        picture.line(a, b, "term")
    picture.dot(234 + 99j, "dot-axis")
    picture.text(81 + 160j, "raw", "note-term", "middle")
    picture.text(239 + 160j, "refined", "note-term", "middle")
    picture.text(81 + 30j, "balls touch points", anchor="middle")
    picture.text(239 + 30j, "balls touch the surface", anchor="middle")
    return picture


def sheets_seams_borders():
    picture = Picture("Three sheets meet in a seam and end in borders; a curve has no faces; junctions are where lines meet")
    at = seen_from(0.5, 0.42, 50, 58 + 44j)
    bottom, top = at(1.3, 1, 0), at(1.3, 1, 2)
    wings = [(at(-0.35, 0.2, 0), at(-0.35, 0.2, 2)), (at(3.0, -0.2, 0), at(3.0, -0.2, 2)), (at(2.0, 2.9, 0.2), at(2.0, 2.9, 2.2))]
    for low, high in (wings[2], wings[0], wings[1]):
        picture.path([bottom, low, high, top], "sheet", closed=True)
        picture.path([bottom, low, high, top], "axis")
    picture.line(bottom, top, "term")
    low, high = wings[1]
    end = (low + high) / 2
    curve = [end, end + 22 + 6j, end + 46 + 2j, end + 68 + 10j]
    picture.path(curve, "curve")
    for place in (bottom, top, end, curve[-1]):
        picture.dot(place, "dot", 3.6)
    picture.text(top - 6 + 10j, "seam", "note-term", "end")
    picture.text((wings[0][0] + wings[0][1] + bottom + top) / 4, "sheet", "note-axis", "middle")
    picture.text(low + 8 + 4j, "border", "note-axis")
    picture.text(curve[2] + 4 - 16j, "curve", anchor="middle")
    picture.text(bottom - 6 - 16j, "junction", anchor="end")
    return picture


def trunk_and_branch():
    picture = Picture("The parts of an axis: branches touch the surface, trunks do not")
    picture.path(box(24, 40, 296, 164), "solid", closed=True)
    ends = [86 + 102j, 234 + 102j]
    for end, corner in ((0, 24 + 40j), (0, 24 + 164j), (1, 296 + 40j), (1, 296 + 164j)):
        picture.line(ends[end], corner, "axis")
    picture.line(*ends, "term")
    picture.text(160 + 112j, "trunk", "note-term", "middle")
    for at in (62 + 142j, 262 + 142j, 62 + 56j, 262 + 56j):
        picture.text(at, "branch", "note-axis", "start" if at.real < 160 else "end")
    picture.text(160 + 16j, "branches reach the surface", anchor="middle")
    return picture


def topology_face():
    picture = Picture("A topology face is a Voronoi face between two neighbours on the surface that does not reach it")
    at = seen_from(0.3, 0.55, 54, 26 + 66j)
    picture.path([at(x, y, 0) for x, y in ((0, 0), (4.6, 0), (4.6, 2.6), (0, 2.6))], "solid", closed=True)
    a, b = (1.75, 1.1), (2.75, 1.1)  # the face lies in the plane halfway between them
    x = (a[0] + b[0]) / 2
    for at_x, at_y in ((0.6, 0.5), (0.8, 2.0), (1.6, 2.3), (3.9, 0.6), (3.6, 1.9), (2.3, 0.25)):
        picture.dot(at(at_x, at_y, 0), radius=2.4)
    picture.path([at(x, 1.1, 0), at(*a, 0)], "dashed")
    picture.path([at(x, 1.1, 0), at(*b, 0)], "dashed")
    picture.path([at(x, 0.5, 0.5), at(x, 1.5, 0.7), at(x, 1.7, 1.7), at(x, 0.4, 1.7)], "region", closed=True)
    picture.path([at(u, v, 1.7) for u, v in ((0.4, 0.4), (4.2, 0.4), (4.2, 1.7), (0.4, 1.7))], "sheet", closed=True)
    picture.line(at(x, 0.4, 1.7), at(x, 1.7, 1.7), "term")
    picture.dot(at(*a, 0), "dot-term", 4), picture.dot(at(*b, 0), "dot-term", 4)
    picture.text(at(x, 0.5, 0.9) - 8 + 0j, "topology face", "note-term", "end")
    picture.text(at(0.9, 0.75, 1.7), "sheet", "note-axis")
    picture.text(at(0.15, 0.12, 0) + 60 - 34j, "surface", anchor="middle")
    return picture


PICTURES = {"medial-axis": medial_axis, "raw-and-refined": raw_and_refined, "sheets-seams-borders": sheets_seams_borders,
            "trunk-and-branch": trunk_and_branch, "topology-face": topology_face}
