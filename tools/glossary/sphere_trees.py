"""Pictures of sphere-trees: what they are, what makes them conservative, and how they are built."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import box, clipped, min_circle, round_trip


def quarters(left, bottom, width, height, level):
    """The boxes of a level of the tree that divides a box into four again and again."""
    n = 2 ** level
    return [box(left + width * i / n, bottom + height * j / n, left + width * (i + 1) / n, bottom + height * (j + 1) / n)
            for j in range(n) for i in range(n)]


def sphere_tree():
    picture = Picture("Three levels of a sphere-tree: each covers the surface more tightly than the one above")
    width, height = 68, 52
    for level, label in enumerate(("root", "level 1", "level 2")):
        left = 22 + 104 * level
        picture.path(box(left, 72, left + width, 72 + height), "solid", closed=True)
        for corners in quarters(left, 72, width, height, level):
            if any(p.real in (left, left + width) or p.imag in (72, 72 + height) for p in corners):  # the surface is there
                picture.circle(*min_circle(corners), "ball")
        picture.text(complex(left + width / 2, 30), label, "note-axis", "middle")
    picture.text(160 + 172j, "every level covers the surface", "note-term", "middle")
    return picture


def path_rule():
    picture = Picture("Path rule: every point of the surface lies in all balls of a path from the root to a leaf")

    def part(begin, end):
        """Places of the surface between two angles, in degrees."""
        return [160 + 92j + complex(86 * math.cos(t), 50 * math.sin(t)) for t in
                (math.radians(begin + (end - begin) * i / 14) for i in range(15))]

    picture.path(part(0, 180) + part(180, 360)[1:-1], "solid", closed=True)
    for begin in (-90, -30):
        picture.circle(*min_circle(part(begin, begin + 60)), "circle-thin")
    picture.circle(*min_circle(part(90, 270)), "circle-thin")
    root, child, leaf = min_circle(part(0, 346)), min_circle(part(-90, 90)), min_circle(part(30, 90))
    for circle in (root, child, leaf):
        picture.circle(*circle, "term")
    place = part(30, 90)[6]
    picture.dot(place, "dot-term", 4)
    picture.text(62 + 150j, "root", "note-term", "end")
    picture.text(278 + 92j, "child", "note-term")
    picture.text(252 + 162j, "leaf", "note-term")
    picture.line(250 + 164j, leaf[0] + cmath.rect(leaf[1], 0.55), "thin")
    picture.text(160 + 86j, "solid", anchor="middle")
    return picture


def covered_arcs(disks, own, triangle, steps=180):
    """Runs of places on a circle in a triangle: (covered by the inside of another disk, the places)."""
    center, radius = disks[own]
    runs = []
    for i in range(steps + 1):
        place = center + cmath.rect(radius, math.tau * i / steps)
        inside = all(((b - a).conjugate() * (place - a)).imag >= -1e-9 for a, b in zip(triangle, triangle[1:] + triangle[:1]))
        covered = any(abs(place - c) < r for j, (c, r) in enumerate(disks) if j != own)
        state = covered if inside else None
        if runs and runs[-1][0] == state:
            runs[-1][1].append(place)
        else:
            runs.append((state, ([runs[-1][1][-1]] if runs else []) + [place]))
    return [(state, places) for state, places in runs if state is not None]


def boundary_lemma():
    picture = Picture("Boundary lemma: a triangle is covered if every arc of a circle in it lies inside another disk")
    for left, radius in ((0, 24), (160, None)):
        triangle = [left + 16 + 40j, left + 144 + 40j, left + 80 + 40j + 64j * math.sqrt(3)]
        disks = [(corner, 67) for corner in triangle] + ([(sum(triangle) / 3, radius)] if radius else [])
        picture.path(triangle, "solid", closed=True)
        for disk in disks:
            part = round_trip(*disk, 48)
            for a, b in zip(triangle, triangle[1:] + triangle[:1]):
                part = clipped(part, a, (b - a) * -1j)
            picture.path(part, "disk", closed=True)
        for own in range(len(disks)):
            for covered, places in covered_arcs(disks, own, triangle):
                picture.path(places[::4] + places[-1:], "axis" if covered else "term")
    picture.text(80 + 174j, "covered", "note-axis", "middle")
    picture.text(240 + 174j, "not covered", "note-term", "middle")
    picture.text(80 + 16j, "arcs inside disks", "note-axis", "middle")
    picture.text(240 + 16j, "open arcs", "note-term", "middle")
    return picture


def inaccuracy():
    picture = Picture("The inaccuracy of a ball: the largest distance of its surface from the solid, outside of it")
    picture.path([12 + 14j, 308 + 14j, 308 + 70j, 190 + 70j, 190 + 112j, 12 + 112j], "inside", closed=True)
    picture.path([12 + 112j, 190 + 112j, 190 + 70j, 308 + 70j], "surface")
    center, radius = 182 + 104j, 74
    picture.circle(center, radius, "ball")
    nearest = max((center + cmath.rect(radius, math.radians(i / 4)) for i in range(0, 721)), key=distance_to_step)
    foot = complex(min(nearest.real, 190), 112) if distance_to_step(nearest) < nearest.imag - 70 else complex(nearest.real, 70)
    picture.arrow(foot, nearest, "size-term", both=True)
    picture.dot(nearest, "dot-term", 4)
    picture.dot(center, "dot-axis")
    picture.text(nearest + 8 - 20j, "inaccuracy", "note-term")
    picture.text(60 + 60j, "solid")
    picture.text(112 + 172j, "ball", "note-axis", "end")
    return picture


def distance_to_step(place):
    """To the solid of inaccuracy(): below 70, and below 112 to the left of 190."""
    if place.imag <= 70 or (place.real <= 190 and place.imag <= 112):
        return 0.0
    return min(place.imag - 70, abs(complex(max(place.real - 190, 0), max(place.imag - 112, 0))))


def merging():
    picture = Picture("Merging: two balls become one around all points that they touch")
    first, second = (54 + 112j, 38), (108 + 78j, 28)
    points = [circle[0] + cmath.rect(circle[1], math.radians(angle)) for circle, angles in ((first, (75, 155, 250)), (second, (15, 150, 285)))
              for angle in angles]
    for left in (0, 160):
        spots = [p + left for p in points]
        if left:
            picture.circle(*min_circle(spots), "region")
        for circle in (first, second):
            picture.circle(circle[0] + left, circle[1], "circle-thin" if left else "ball")
        for spot in spots:
            picture.dot(spot)
    picture.text(80 + 176j, "two balls", "note-axis", "middle")
    picture.text(240 + 176j, "merged", "note-term", "middle")
    picture.text(160 + 14j, "points: forming points of both", anchor="middle")
    return picture


def piece_in(circle, height):
    """The ends of the part of a level line in a circle."""
    half = math.sqrt(circle[1] ** 2 - (height - circle[0].imag) ** 2)
    return complex(circle[0].real - half, height), complex(circle[0].real + half, height)


def redundant_sphere():
    picture = Picture("A redundant sphere: its siblings cover all of the surface that it covers")
    picture.path(box(12, 14, 308, 84), "inside", closed=True)
    picture.line(12 + 84j, 308 + 84j, "surface")
    siblings, own = [(92 + 92j, 76), (228 + 92j, 76)], (160 + 98j, 50)
    for circle in siblings:
        picture.circle(*circle, "ball")
    picture.circle(*own, "region")
    picture.line(*piece_in(own, 84), "term")
    picture.text(160 + 170j, "redundant", "note-term", "middle")
    picture.text(64 + 122j, "sibling", "note-axis", "middle")
    picture.text(256 + 122j, "sibling", "note-axis", "middle")
    picture.text(160 + 66j, "its surface", "note-term", "middle")
    return picture


def aunt():
    picture = Picture("An aunt is a sibling of a ball's parent; this one covers all of the surface that its niece covers")
    picture.path(box(12, 14, 308, 72), "inside", closed=True)
    picture.line(12 + 72j, 308 + 72j, "surface")
    parent, other, niece = (112 + 84j, 78), (212 + 84j, 78), (164 + 82j, 26)
    picture.circle(*parent, "ball")
    picture.circle(*other, "term")
    picture.circle(*niece, "region")
    picture.line(*piece_in(niece, 72), "term")
    for at, label, style in ((72 + 176j, "parent", "note-axis"), (252 + 176j, "aunt", "note-term")):
        picture.text(at, label, style, "middle")
    picture.text(164 + 118j, "niece", anchor="middle")
    picture.text(164 + 34j, "its surface is in the aunt, too", anchor="middle")
    return picture


PICTURES = {"sphere-tree": sphere_tree, "path-rule": path_rule, "boundary-lemma": boundary_lemma, "inaccuracy": inaccuracy,
            "merging": merging, "redundant-sphere": redundant_sphere, "aunt": aunt}
