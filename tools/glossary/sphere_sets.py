"""Pictures of sphere sets."""
import math

from glossary.canvas import Picture
from glossary.plane import box


def area_of_row(radius, spacing, count):
    """The area of the union of equal disks in a row, of which neighbours alone overlap."""
    half = spacing / 2
    lens = 0 if radius <= half else 2 * radius ** 2 * math.acos(half / radius) - 2 * half * math.sqrt(radius ** 2 - half ** 2)
    return count * math.pi * radius ** 2 - (count - 1) * lens


def balanced_radius(width, height, count):
    low, high = 0.0, height
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if area_of_row(middle, width / count, count) < width * height else (low, middle)
    return low


def cover_inside_balanced():
    picture = Picture("Four sphere sets of the same solid: they cover it, lie inside it, have its volume, or are particles")
    width, height, count = 104, 46, 3
    step = width / count
    fits = {"cover": (math.hypot(step, height) / 2, step), "inside": (height / 2, (width - height) / (count - 1)),
            "balanced": (balanced_radius(width, height, count), step), "particles": (step / 2, step)}  # radius and spacing
    for k, (name, (radius, spacing)) in enumerate(fits.items()):
        left, bottom = 28 + 160 * (k % 2), 126 - 88 * (k // 2)
        picture.path(box(left, bottom, left + width, bottom + height), "solid", closed=True)
        first = left + width / 2 - spacing * (count - 1) / 2
        for i in range(count):
            picture.circle(complex(first + spacing * i, bottom + height / 2), radius, "ball")
        picture.text(complex(left + width / 2, bottom - 20), name, "note-term", "middle")
    return picture


PICTURES = {"cover-inside-balanced": cover_inside_balanced}
