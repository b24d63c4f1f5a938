"""Pictures of the section on Voronoi diagrams."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import box, cell, circumcircle, clipped, edges_between, is_inside, voronoi_vertices

FRAME = box(6, 6, 314, 194)


def kept_in(a, b, frame=FRAME):
    """The part of a segment within a convex frame, or nothing."""
    ends = [a, b]
    low, high = 0.0, 1.0
    for p, q in zip(frame, frame[1:] + frame[:1]):
        normal = (q - p) * -1j
        at_a, at_b = ((normal.conjugate() * (end - p)).real for end in ends)
        if at_a > 0 and at_b > 0:
            return None
        if at_a > 0 or at_b > 0:
            cut = at_a / (at_a - at_b)
            low, high = (max(low, cut), high) if at_a > 0 else (low, min(high, cut))
    return (a + (b - a) * low, a + (b - a) * high) if low < high else None


def draw_diagram(picture, sites, style):
    """All Voronoi edges in the frame, the unbounded ones by far sites around it."""
    far = [160 + 100j + cmath.rect(2000, math.tau * i / 12) for i in range(12)]
    vertices = voronoi_vertices(sites + far)
    for a, b in edges_between(vertices):
        part = kept_in(a[0], b[0])
        if part:
            picture.line(*part, style)
    return [v for v in vertices if max(v[2]) < len(sites)]


def forming_points():
    picture = Picture("A Voronoi vertex is equally far from its forming points")
    outline = [160 + 92j + complex(138 * math.cos(t), 70 * math.sin(t) + 8 * math.cos(2 * t)) for t in (math.tau * i / 72 for i in range(72))]
    picture.path(outline, "solid", closed=True)
    sites = [160 + 92j + complex(138 * math.cos(t), 70 * math.sin(t) + 8 * math.cos(2 * t)) for t in (0.1 + math.tau * i / 13 for i in range(13))]
    vertices = draw_diagram(picture, sites, "thin")
    center, radius, three = max((v for v in vertices if is_inside(v[0], outline)), key=lambda v: (v[1], v[0].real))
    picture.circle(center, radius, "ball")
    for i in three:
        picture.line(center, sites[i], "term-dashed")
    for i, site in enumerate(sites):
        picture.dot(site, "dot-term" if i in three else "dot", 4 if i in three else 2.6)
    picture.dot(center, "dot-axis", 4)
    picture.text(160 + 183j, "forming points: in space four of them", "note-term", "middle")
    picture.text(center + 8 - 14j, "vertex", "note-axis")
    return picture


def highest_first():
    picture = Picture("A new point first deletes the vertex that it contradicts most, then that one's neighbours")
    sites = [complex(x, y) for x, y in ((30, 40), (96, 20), (170, 34), (250, 22), (296, 70), (282, 150), (216, 178), (140, 170), (62, 176), (22, 116),
                                        (112, 112), (206, 104))]
    vertices = draw_diagram(picture, sites, "thin")
    new = 158 + 112j
    doomed = sorted((v for v in vertices if abs(v[0] - new) < v[1]), key=lambda v: abs(v[0] - new) - v[1])
    for center, radius, _ in doomed[:1]:
        picture.circle(center, radius, "circle")
    for site in sites:
        picture.dot(site, "dot", 2.6)
    picture.path(cell(new, sites, FRAME), "region", closed=True)
    for number, (center, _, _) in enumerate(doomed, 1):
        picture.dot(center, "dot-axis", 3.4)
        picture.text(center + 7 - 3j, str(number), "note-axis")
    picture.dot(new, "dot-term", 4)
    picture.text(new + 8 - 4j, "new point", "note-term")
    picture.text(160 + 184j, "vertices deleted, the deepest first", anchor="middle")
    return picture


def certificate():
    picture = Picture("No neighbour's point lies in the sphere of a vertex, so no point at all does")
    a, b, c, d = 116 + 36j, 152 + 156j, 60 + 114j, 262 + 88j
    center, radius = circumcircle(a, b, c)
    for p, q in ((a, b), (b, c), (c, a), (a, d), (b, d)):
        picture.line(p, q, "thin")
    picture.circle(center, radius, "ball")
    edge = center + (d - center) / abs(d - center) * radius
    picture.arrow(edge, d, "size-term", both=True)
    for p in (a, b, c):
        picture.dot(p)
    picture.dot(d, "dot-term", 4)
    picture.dot(center, "dot-axis", 4)
    picture.text(center + 7 - 14j, "vertex", "note-axis")
    picture.text(246 + 150j, "not in the sphere:", "note-term", "middle")
    picture.text(246 + 134j, "proven", "note-term", "middle")
    return picture


def gap_crossing():
    picture = Picture("A Voronoi cell that reaches across a gap to another part of the surface, and the point that cuts it off")
    upper, lower = [x + 106j for x in (14, 62, 126)], [x + 86j for x in (14, 44, 140)]
    for left, added in ((0, None), (160, 70 + 86j)):
        picture.path([p + left for p in box(8, 106, 152, 176)], "solid", closed=True)
        picture.path([p + left for p in box(8, 38, 152, 86)], "solid", closed=True)
        sites = [p + left for p in upper + lower] + ([added + left] if added else [])
        frame = [p + left for p in box(8, 38, 152, 176)]
        own = cell(upper[1] + left, sites, frame)
        picture.path(own, "region", closed=True)
        crossing = sorted(p.real for p in clipped(clipped(own, left + 86j, 1j), left + 85.9j, -1j))
        if not added:
            picture.line(complex(crossing[0], 86), complex(crossing[-1], 86), "term")
        for site in sites[:6]:
            picture.dot(site, radius=3.2)
        if added:
            picture.dot(added + left, "dot-term", 4.4)
        picture.text(left + 80 + 180j, "after" if added else "before", anchor="middle")
    picture.text(126 + 92j, "gap", anchor="middle")
    picture.text(80 + 14j, "cell meets both sides", "note-term", "middle")
    picture.text(240 + 14j, "a point is added", "note-term", "middle")
    return picture


def neck():
    picture = Picture("A cell that contains a whole ring of a part thinner than the spacing of the points")
    top, bottom = 118, 82
    for left in (True, False):
        x = (lambda value: value) if left else (lambda value: 320 - value)
        picture.path([complex(x(14), 160), complex(x(62), 160), complex(x(86), top), complex(x(160), top), complex(x(160), bottom),
                      complex(x(86), bottom), complex(x(62), 40), complex(x(14), 40)], "inside", closed=True)
        picture.path([complex(x(14), 160), complex(x(62), 160), complex(x(86), top), complex(x(160), top)], "surface")
        picture.path([complex(x(14), 40), complex(x(62), 40), complex(x(86), bottom), complex(x(160), bottom)], "surface")
    sites = [94 + 118j, 160 + 118j, 228 + 118j]
    cuts = [(sites[0] + sites[1]).real / 2, (sites[1] + sites[2]).real / 2]
    bend = 7
    ring = [complex(cuts[0] - bend * math.cos(t), 100 + 18 * math.sin(t)) for t in (math.pi / 2 - math.pi * i / 16 for i in range(17))]
    ring += [complex(cuts[1] - bend * math.cos(t), 100 + 18 * math.sin(t)) for t in (-math.pi / 2 + math.pi * i / 16 for i in range(17))]
    picture.path(ring, "region", closed=True)
    for cut in cuts:
        picture.ellipse(complex(cut, 100), bend, 18, "term")
        picture.line(complex(cut, 60), complex(cut, 140), "dashed")
    for site in sites + [30 + 160j, 56 + 160j, 40 + 40j, 60 + 40j, 280 + 160j, 300 + 40j, 262 + 40j, 262 + 160j]:
        picture.dot(site, radius=3.2)
    picture.text(160 + 150j, "one point, one ring", "note-term", "middle")
    picture.text(160 + 40j, "its cell", anchor="middle")
    return picture


PICTURES = {"forming-points": forming_points, "highest-first": highest_first, "certificate": certificate, "gap-crossing": gap_crossing,
            "neck": neck}
