"""Pictures of bounds on motion, in space and in space and time."""
import cmath
import math

from glossary.canvas import Picture
from glossary.plane import clipped, round_trip

# In pixels, one to the right for each unit of time.
START, RADIUS, VELOCITY, DRIFT, ACCELERATION = 34 + 84j, 16, 0.22, 0.06, 0.0026


def motion_bound():
    picture = Picture("A motion bound: the centre stays in growing balls along its velocity, cut by a half-space")
    velocity, away = 0.748 + 0.1j, cmath.rect(1, math.radians(-62))
    for time in (70, 125, 180):
        center, reach = START + velocity * time, 0.1 * time + 0.0015 * time ** 2
        ball = round_trip(center, reach, 72)
        picture.path(ball, "dashed", closed=True)
        picture.path(clipped(ball, center + away * 0.1 * time, away), "region", closed=True)
    picture.line(START, START + velocity * 204, "axis")
    picture.arrow(START, START + velocity * 60, "axis")
    picture.dot(START, "dot-axis", 4)
    picture.arrow(256 + 62j, 256 + 62j + away * 34)
    picture.text(284 + 40j, "d", anchor="middle")
    picture.text(START - 4 - 20j, "velocity", "note-axis")
    picture.text(START - 12 + 12j, "start")
    picture.text(14 + 180j, "where the centre can be", "note-term")
    picture.text(16 + 14j, "half-space: no acceleration along d")
    return picture


def horn_edge(time, side):
    return START.imag + VELOCITY * time + side * (RADIUS + DRIFT * time + ACCELERATION * time ** 2 / 2)


def draw_axes(picture, until):
    picture.arrow(24 + 26j, complex(until, 26))
    picture.arrow(24 + 26j, 24 + 190j)
    picture.text(until + 10j, "time", anchor="end")
    picture.text(30 + 180j, "x")


def horn_and_hypertrapezoid():
    picture = Picture("A parabolic horn and the hypertrapezoid around it, in one dimension of space and time")
    draw_axes(picture, 308)
    end = 170
    upper = [complex(START.real + t, horn_edge(t, 1)) for t in range(0, end + 1, 10)]
    lower = [complex(START.real + t, horn_edge(t, -1)) for t in range(0, end + 1, 10)]
    picture.path([lower[0], upper[0], upper[-1], lower[-1]], "ball", closed=True)
    picture.path(upper + lower[::-1], "region", closed=True)
    picture.line(START, START + complex(end, VELOCITY * end), "axis")
    picture.line(START, START + complex(0, RADIUS), "term"), picture.line(START, START - complex(0, RADIUS), "term")
    picture.dot(START, "dot-axis", 3.4)
    picture.text(140 + 90j, "horn", "note-term", "middle")
    picture.text(96 + 164j, "hypertrapezoid", "note-axis", "middle")
    picture.line(110 + 160j, 120 + 128j, "thin")
    picture.text(316 + 112j, "equal at the", anchor="end")
    picture.text(316 + 96j, "start and end", anchor="end")
    picture.text(40 + 34j, "body")
    return picture


def window_and_expiry():
    picture = Picture("A window is the time for which a body's box in space and time is kept; the motion bound lasts until its expiry")
    draw_axes(picture, 308)
    end, window = 234, 78
    upper = [complex(START.real + t, horn_edge(t * 0.74, 1)) for t in range(0, end + 1, 13)]
    lower = [complex(START.real + t, horn_edge(t * 0.74, -1)) for t in range(0, end + 1, 13)]
    picture.path(upper + lower[::-1], "ball", closed=True)
    for k in range(3):
        begin, stop = window * k, min(window * (k + 1), end)
        top = max(horn_edge(t * 0.74, 1) for t in (begin, stop))
        bottom = min(horn_edge(begin * 0.74 + (stop - begin) * 0.74 * i / 40, -1) for i in range(41))
        corners = [complex(START.real + begin, bottom), complex(START.real + stop, bottom), complex(START.real + stop, top),
                   complex(START.real + begin, top)]
        picture.path(corners, "term" if k == 0 else "term-dashed", closed=True)
    picture.line(complex(START.real + end, 20), complex(START.real + end, 192), "size")
    picture.arrow(complex(START.real, 40), complex(START.real + window, 40), "size-term", both=True)
    picture.text(complex(START.real + window / 2, 46), "window", "note-term", "middle")
    picture.text(START.real + end - 4 + 34j, "expiry", anchor="end")
    picture.text(96 + 152j, "motion bound", "note-axis", "middle")
    picture.line(116 + 148j, 146 + 120j, "thin")
    return picture


PICTURES = {"motion-bound": motion_bound, "horn-and-hypertrapezoid": horn_and_hypertrapezoid, "window-and-expiry": window_and_expiry}
