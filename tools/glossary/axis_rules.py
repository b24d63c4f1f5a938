"""Pictures of the rules by which medial axes end and of the measures of single balls."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import arc_places, box


def draw_wedge(picture, apex, half_angle):
    """A wedge that opens to the left, as far as the picture goes."""
    top, bottom, left = 189, 11, 11
    above = complex(apex.real - (top - apex.imag) / math.tan(half_angle), top)
    below = complex(apex.real - (apex.imag - bottom) / math.tan(half_angle), bottom)
    picture.path([complex(left, bottom), below, apex, above, complex(left, top)], "inside", closed=True)
    picture.path([below, apex, above], "surface")


def touching_ball(apex, half_angle, radius):
    """The ball of a radius in a wedge, and the places where it touches the sides."""
    center = apex - radius / math.sin(half_angle)
    way = math.pi / 2 - half_angle
    return center, (center + cmath.rect(radius, way), center + cmath.rect(radius, -way))


def contacts():
    picture = Picture("The contacts of a ball, the contact angle between them, and the object angle, which is half of it")
    apex, half = 300 + 100j, math.radians(26)
    draw_wedge(picture, apex, half)
    center, touched = touching_ball(apex, half, 66)
    picture.line(center - 130, apex, "axis")
    picture.circle(center, 66, "ball")
    angle = math.pi / 2 - half
    picture.path([center] + arc_places(center, 26, -angle, angle), "region", closed=True)
    for place in touched:
        picture.line(center, place, "thin")
        picture.dot(place, "dot-term", 4)
    picture.dot(center, "dot-axis", 3.6)
    picture.arc(center, 44, 0, angle, "size-term")
    picture.text(touched[0] + 2 + 14j, "contact", "note-term")
    picture.text(touched[1] + 4 - 20j, "contact", "note-term")
    picture.text(center - 8 - 14j, "contact angle", "note-term", "end")
    picture.line(238 + 152j, center + cmath.rect(44, 0.6), "thin")
    picture.text(224 + 154j, "object angle", "note-term")
    picture.text(28 + 106j, "sheet", "note-axis")
    return picture


def border_loss():
    picture = Picture("What is lost of the surface if a sheet ends with a given ball: r (1 / cos(a / 2) - 1)")
    apex, half = 304 + 104j, math.radians(33)
    draw_wedge(picture, apex, half)
    radius = 80
    center, touched = touching_ball(apex, half, radius)
    angle = math.pi / 2 - half
    picture.path([touched[0], apex, touched[1]] + arc_places(center, radius, -angle, angle), "fill", closed=True)
    picture.circle(center, radius, "ball")
    picture.line(24 + 104j, center, "axis")
    picture.line(center, apex, "axis-dashed")
    for place in touched:
        picture.line(center, place, "thin")
        picture.dot(place)
    picture.dot(center, "dot-axis", 3.6)
    picture.arc(center, 20, -angle, angle, "size")
    picture.arrow(center + radius, apex, "size-term", both=True)
    picture.text(center + 24 + 6j, "a")
    picture.text(center + (touched[0] - center) * 0.55 - 6, "r", anchor="end")
    picture.text(262 + 154j, "loss", "note-term")
    picture.line(266 + 150j, (center + radius + apex) / 2 + 2j, "thin")
    picture.text(40 + 114j, "sheet", "note-axis")
    picture.text(center + 4 - 22j, "border", "note-axis", "middle")
    return picture


def feature():
    picture = Picture("An edge is a feature if it lies far outside the largest ball between its faces")
    bar = box(14, 60, 148, 116)
    picture.path(bar, "solid", closed=True)
    radius = 28
    center, edge = 148 - radius + 88j, 148 + 116j
    draw_loss(picture, center, radius, edge)
    count, middle, outer = 14, 238 + 92j, 60
    corners = [middle + cmath.rect(outer, math.tau * (i + 0.5) / count + math.pi / 2) for i in range(count)]
    picture.path(corners, "solid", closed=True)
    draw_loss(picture, middle, outer * math.cos(math.pi / count), corners[-2])
    picture.text(81 + 174j, "large loss: feature", "note-term", "middle")
    picture.text(239 + 174j, "small loss: none", anchor="middle")
    picture.text(81 + 20j, "edge of a plate", anchor="middle")
    picture.text(239 + 16j, "edge of a coarse tube", anchor="middle")
    return picture


def draw_loss(picture, center, radius, edge):
    way = (edge - center) / abs(edge - center)
    picture.circle(center, radius, "ball")
    picture.line(center, center + radius * way, "thin")
    picture.line(center + radius * way, edge, "term")
    picture.dot(center, "dot-axis")
    picture.dot(edge, "dot-term", 4)


def open_place():
    picture = Picture("An open place of the surface: no ball of the axis comes near it, so the sheet is extended")
    for left, reached in ((0, False), (160, True)):
        shape = [left + p for p in box(12, 60, 148, 132)]
        picture.path(shape, "solid", closed=True)
        centers = [left + 54 + 96j] + ([left + 112 + 96j] if reached else [])
        top, bottom = [c + 36j for c in (centers[0], centers[-1])], [c - 36j for c in (centers[0], centers[-1])]
        picture.path(arc_places(centers[0], 36, math.pi / 2, 1.5 * math.pi) + [bottom[1]] +
                     arc_places(centers[-1], 36, -math.pi / 2, math.pi / 2) + [top[0]], "ball", closed=True)
        picture.line(left + 36 + 96j, centers[-1], "axis")
        picture.dot(centers[-1], "dot-axis")
        if not reached:
            picture.path([left + 54 + 132j, shape[2], shape[1], left + 54 + 60j], "term")
        picture.text(left + 80 + 152j, "extended" if reached else "open place", "note" if reached else "note-term", "middle")
    picture.text(80 + 32j, "nothing comes near", anchor="middle")
    picture.text(240 + 32j, "covered", anchor="middle")
    return picture


PICTURES = {"contacts": contacts, "border-loss": border_loss, "feature": feature, "open-place": open_place}
