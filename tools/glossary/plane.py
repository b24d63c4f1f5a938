"""Plane geometry for the pictures: places are complex numbers, circles are (centre, radius)."""
import cmath
import itertools
import math


def dot(a, b):
    return (a.conjugate() * b).real


def cross(a, b):
    return (a.conjugate() * b).imag


def box(left, bottom, right, top):
    return [complex(left, bottom), complex(right, bottom), complex(right, top), complex(left, top)]


def round_trip(center, radius, count=60, begin=0.0):
    return [center + cmath.rect(radius, begin + math.tau * i / count) for i in range(count)]


def arc_places(center, radius, begin, end, count=24):
    return [center + cmath.rect(radius, begin + (end - begin) * i / count) for i in range(count + 1)]


def circumcircle(a, b, c):
    b, c = b - a, c - a
    area = 2 * cross(b, c)
    if abs(area) < 1e-9:
        return None
    center = -1j * (abs(b) ** 2 * c - abs(c) ** 2 * b) / area
    return a + center * 1, abs(center)


def min_circle(places):
    """The smallest circle around some places, by trying all pairs and triples."""
    best = None
    candidates = [((a + b) / 2, abs(a - b) / 2) for a, b in itertools.combinations(places, 2)]
    candidates += [circle for three in itertools.combinations(places, 3) if (circle := circumcircle(*three))]
    for center, radius in candidates:
        if all(abs(p - center) <= radius + 1e-9 for p in places) and (best is None or radius < best[1]):
            best = center, radius
    return best


def clipped(polygon, point, normal):
    """The part of a convex polygon at which dot(normal, place - point) <= 0."""
    kept = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        at_a, at_b = dot(normal, a - point), dot(normal, b - point)
        if at_a <= 0:
            kept.append(a)
        if (at_a < 0 < at_b) or (at_b < 0 < at_a):
            kept.append(a + (b - a) * at_a / (at_a - at_b))
    return kept


def cell(site, sites, frame):
    """The Voronoi cell of a site within a convex frame."""
    for other in sites:
        if other != site:
            frame = clipped(frame, (site + other) / 2, other - site)
    return frame


def voronoi_vertices(sites):
    """(centre, radius, the three sites) of every Voronoi vertex: circles through three sites that hold no other one."""
    found = []
    for three in itertools.combinations(range(len(sites)), 3):
        circle = circumcircle(*(sites[i] for i in three))
        if circle and all(abs(p - circle[0]) >= circle[1] - 1e-9 for p in sites):
            found.append((circle[0], circle[1], three))
    return found


def edges_between(vertices):
    """Pairs of Voronoi vertices that share two sites."""
    return [(a, b) for a, b in itertools.combinations(vertices, 2) if len(set(a[2]) & set(b[2])) == 2]


def is_inside(place, polygon):
    inside = False
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if (a.imag > place.imag) != (b.imag > place.imag):
            inside ^= place.real < a.real + (place.imag - a.imag) * (b.real - a.real) / (b.imag - a.imag)
    return inside


def hull_of_disks(disks, count=96):
    """The convex hull of some disks: its boundary, in the direction of each of `count` normals."""
    places = []
    for i in range(count):
        way = cmath.rect(1, math.tau * i / count)
        center, radius = max(disks, key=lambda disk: dot(way, disk[0]) + disk[1])
        places.append(center + radius * way)
    return places


def meeting_points(a, b):
    """Where two circles cross; the first is to the left of the way from a's centre to b's."""
    (p, r), (q, s) = a, b
    distance = abs(q - p)
    along = (distance ** 2 + r ** 2 - s ** 2) / (2 * distance)
    across = math.sqrt(max(r ** 2 - along ** 2, 0))
    way = (q - p) / distance
    return p + way * complex(along, across), p + way * complex(along, -across)


def parabola(focus, directrix, begin, end, count=16):
    """Places equally far from a focus and a horizontal line, between two abscissas."""
    height = focus.imag - directrix
    xs = (begin + (end - begin) * i / count for i in range(count + 1))
    return [complex(x, directrix + ((x - focus.real) ** 2 + height ** 2) / (2 * height)) for x in xs]


def seen_from(yaw=0.62, pitch=0.5, scale=1.0, origin=0j):
    """A parallel projection of places (x, y, z), z upwards."""
    def project(x, y, z):
        right = x * math.cos(yaw) + y * math.sin(yaw)
        depth = -x * math.sin(yaw) + y * math.cos(yaw)
        return origin + scale * complex(right, z * math.cos(pitch) + depth * math.sin(pitch))
    return project
