"""Pictures of pieces of medial axes: how they hang together, and what is wrong with some."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import parabola

ROW = math.sqrt(3) / 2


def lattice(origin, size):
    """Maps columns and rows of equilateral triangles to places."""
    return lambda column, row: origin + size * complex(column + 0.5 * (row % 2), ROW * row)


def triangles_of(columns, rows):
    """The corners (column, row) of the triangles of a lattice."""
    for row in range(rows):
        for column in range(columns):
            if row % 2 == 0:
                yield (column, row), (column + 1, row), (column, row + 1)
                if column + 1 < columns:
                    yield (column + 1, row), (column + 1, row + 1), (column, row + 1)
            else:
                yield (column, row), (column + 1, row + 1), (column, row + 1)
                if column + 1 < columns:
                    yield (column, row), (column + 1, row), (column + 1, row + 1)


def draw_net(picture, at, columns, rows, without=()):
    for corners in triangles_of(columns, rows):
        if set(corners) not in [set(others) for others in without]:
            picture.path([at(*corner) for corner in corners], "sheet", closed=True)


def stem_and_bridge():
    picture = Picture("A stem joins one vertex by one edge; a bridge joins two pieces over the outside")
    for center, rx, ry in ((98 + 104j, 86, 74), (250 + 104j, 56, 74)):
        picture.ellipse(center, rx, ry, "solid")
    left, right = lattice(52 + 78j, 30), lattice(226 + 92j, 24)
    draw_net(picture, left, 3, 2)
    draw_net(picture, right, 2, 1)
    foot, lost = left(1, 2), left(1, 2) + 22 + 24j
    picture.line(foot, lost, "term")
    ends = left(2, 1), right(0, 0)
    picture.line(*ends, "term-dashed")
    for place in (foot, *ends):
        picture.dot(place, "dot-axis")
    picture.dot(lost, "dot-term", 4)
    picture.text(lost + 8 - 2j, "stem", "note-term")
    picture.text(189 + 84j, "bridge", "note-term", "middle")
    picture.text(189 + 172j, "outside", anchor="middle")
    picture.text(76 + 48j, "solid", anchor="middle")
    picture.text(252 + 48j, "solid", anchor="middle")
    return picture


def spike_and_flake():
    picture = Picture("A spike and a flake hang on an axis by one vertex and reach no farther than two radii of its ball")
    at = lattice(74 + 22j, 40)
    draw_net(picture, at, 4, 2)
    spike, flake = at(0, 2), at(3, 2)
    for joint in (spike, flake):
        picture.circle(joint, 24, "ball")
        picture.circle(joint, 48, "dashed")
    picture.path([spike, spike - 12 + 20j, spike - 10 + 42j], "term")
    picture.path([flake, flake + 16 + 40j, flake - 14 + 34j], "region", closed=True)
    for joint in (spike, flake):
        picture.dot(joint, "dot-axis")
    picture.text(spike + 0 + 62j, "spike", "note-term", "middle")
    picture.text(flake + 0 + 62j, "flake", "note-term", "middle")
    tip = spike + cmath.rect(48, math.radians(150))
    picture.arrow(spike, tip)
    picture.text(tip - 2 + 8j, "2 r", anchor="end")
    picture.text(flake + 30 - 30j, "sheet", "note-axis")
    return picture


def notch():
    picture = Picture("A notch: two edges of a border that face each other where the sheet should go on; a triangle fills it")
    gap = ((2, 2), (2, 3), (1, 3))
    for left, filled in ((0, False), (160, True)):
        at = lattice(left + 10 + 50j, 32)
        draw_net(picture, at, 4, 3, without=(gap,))
        a, v, b = at(1, 3), at(2, 2), at(2, 3)
        if filled:
            picture.path([a, v, b], "region", closed=True)
        else:
            picture.path([a, v, b], "term")
        for place in (a, v, b):
            picture.dot(place, "dot-axis")
        picture.text(left + 80 + 150j, "filled" if filled else "notch", "note-term", "middle")
    picture.text(160 + 24j, "a border of a sheet", "note-axis", "middle")
    return picture


def flap():
    picture = Picture("A flap: a vertex of a border farther from the line through its neighbours than half their distance")
    at = lattice(52 + 24j, 42)
    draw_net(picture, at, 5, 2)
    a, b = at(2, 2), at(3, 2)
    tip = (a + b) / 2 + 62j
    picture.path([a, b, tip], "region", closed=True)
    picture.line(a - 60, b + 60, "dashed")
    foot = (a + b) / 2
    picture.arrow(foot, tip, "size", both=True)
    for place in (a, b):
        picture.dot(place, "dot-axis")
    picture.dot(tip, "dot-term", 4)
    picture.text(tip + 12 - 2j, "flap", "note-term")
    picture.text(a - 12 + 34j, "h &gt; d / 2", anchor="end")
    picture.arrow(a - 16j, b - 16j, "size", both=True)
    picture.text(foot - 32j, "d", anchor="middle")
    return picture


def single_contact_face():
    picture = Picture("A face whose two points have one contact lies on its sheet a second time or stands on the surface; it is removed")
    for left, single in ((0, False), (160, True)):
        low, high = left + 12 + 46j, left + 148 + 46j
        picture.path([low, high, high + 96j, low + 96j], "inside", closed=True)
        picture.line(low, high, "surface")
        middle = left + 80 + 94j
        if not single:
            picture.line(low + 96j, high + 96j, "surface")
            p, q = left + 52 + 46j, left + 108 + 142j
            feet = [left + 80 + 46j, left + 80 + 142j]
            along = (q - p) * 34j / abs(q - p)  # the face lies halfway between its points
            picture.line(middle - along, middle + along, "axis")
        else:
            p, q = left + 46 + 46j, left + 114 + 46j
            feet = [left + 80 + 46j] * 2
            picture.line(middle - 22j, middle + 26j, "term")
        for point, foot in zip((p, q), feet):
            picture.line(middle, point, "dashed")
            picture.arrow(point, foot - (foot - point) / abs(foot - point) * 5, "size")
            picture.dot(point)
        for foot in feet:
            picture.dot(foot, "dot-term", 4)
        picture.dot(middle, "dot-axis")
    picture.text(80 + 178j, "face of a sheet", "note-axis", "middle")
    picture.text(240 + 178j, "single-contact face", "note-term", "middle")
    picture.text(80 + 24j, "two contacts", anchor="middle")
    picture.text(240 + 24j, "one contact", anchor="middle")
    return picture


def spur():
    picture = Picture("A spur: a branch of the axis that a small bump of the surface causes")
    left, right, bottom, top, middle, half_width, apex = 14, 306, 30, 130, 160, 20, 152
    feet = [complex(middle - half_width, top), complex(middle + half_width, top)]
    picture.path([complex(left, bottom), complex(right, bottom), complex(right, top), feet[1], complex(middle, apex), feet[0],
                  complex(left, top)], "solid", closed=True)
    half = (top - bottom) / 2
    rise = parabola(feet[0], bottom, middle - half_width, middle)  # equally far from the bottom and the foot of the bump
    line = [complex(left + half, bottom + half)] + rise
    line += [complex(2 * middle - p.real, p.imag) for p in reversed(line[:-1])]
    picture.path(line, "axis")
    for end, x in ((line[0], left), (line[-1], right)):
        picture.path([complex(x, bottom), end, complex(x, top)], "axis")
    picture.line(rise[-1], complex(middle, apex), "term")
    center = complex(middle, 0.6 * rise[-1].imag + 0.4 * apex)
    radius = min(abs(center - feet[0]), abs(center - feet[1]))
    picture.circle(center, radius, "ball")
    for place in feet:
        picture.line(center, place, "thin")
        picture.dot(place)
    picture.dot(center, "dot-axis")
    picture.text(complex(middle, apex + 18), "spur", "note-term", "middle")
    picture.text(206 + 150j, "small bump")
    picture.text(70 + 92j, "axis", "note-axis")
    return picture


PICTURES = {"spur": spur, "stem-and-bridge": stem_and_bridge, "spike-and-flake": spike_and_flake, "notch": notch, "flap": flap, "single-contact-face": single_contact_face}
