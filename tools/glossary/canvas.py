"""A picture of the glossary: an SVG of 320 x 200 pixels on a ground of its own, in one style.

Places are complex numbers in pixels, y upwards, from the lower left corner. A label that leaves the picture or overlaps another one is an
error, so that no picture has such a label.
"""
import cmath
import math

WIDTH, HEIGHT = 320, 200
INK, GREY, BLUE, RED = "#222", "#6b6b6b", "#0072b2", "#c44e00"  # the last two differ for colour-blind readers, too

STYLES = {
    "solid": f"fill:#e6e8eb;stroke:{INK};stroke-width:1.6",  # what is inside, with its surface
    "triangle": f"fill:#e6e8eb;stroke:{INK};stroke-width:.8",
    "surface": f"fill:none;stroke:{INK};stroke-width:1.6",
    "inside": "fill:#e6e8eb;stroke:none",
    "axis": f"fill:none;stroke:{BLUE};stroke-width:2",
    "sheet": f"fill:{BLUE};fill-opacity:.16;stroke:{BLUE};stroke-width:1.2",
    "ball": f"fill:{BLUE};fill-opacity:.12;stroke:{BLUE};stroke-width:1.2",
    "disk": f"fill:{BLUE};fill-opacity:.14;stroke:none",
    "circle": f"fill:none;stroke:{BLUE};stroke-width:1.2",
    "circle-thin": f"fill:none;stroke:{BLUE};stroke-width:.8",
    "body": f"fill:#fff;fill-opacity:.6;stroke:{INK};stroke-width:1.6",
    "box": f"fill:none;stroke:{INK};stroke-width:1.4;stroke-dasharray:6 3",
    "curve": f"fill:none;stroke:{INK};stroke-width:2",
    "term": f"fill:none;stroke:{RED};stroke-width:2.4",  # what the picture is about
    "region": f"fill:{RED};fill-opacity:.22;stroke:{RED};stroke-width:1.4",
    "fill": f"fill:{RED};fill-opacity:.3;stroke:none",
    "thin": f"fill:none;stroke:{GREY};stroke-width:1",
    "dashed": f"fill:none;stroke:{GREY};stroke-width:1.1;stroke-dasharray:4 3",
    "term-dashed": f"fill:none;stroke:{RED};stroke-width:1.8;stroke-dasharray:5 3",
    "size": f"fill:none;stroke:{INK};stroke-width:1",
    "size-term": f"fill:none;stroke:{RED};stroke-width:1.4",
    "axis-dashed": f"fill:none;stroke:{BLUE};stroke-width:1.4;stroke-dasharray:4 3",
    "dot": f"fill:{INK};stroke:none",
    "dot-axis": f"fill:{BLUE};stroke:none",
    "dot-term": f"fill:{RED};stroke:none",
    "dot-open": f"fill:#fff;stroke:{INK};stroke-width:1.4",
    "note": f"fill:{INK}",
    "note-axis": f"fill:{BLUE}",
    "note-term": f"fill:{RED};font-weight:bold",
}
TEXT = "text{font:12px Helvetica,Arial,'DejaVu Sans',sans-serif;stroke:#fff;stroke-width:3px;stroke-linejoin:round;paint-order:stroke}"
NARROW, WIDE = set("ijlt.,:;'|()[]fr I-"), set("mwMW")


def number(value):
    """One decimal; the last bits of sines and cosines, which differ between libraries, decide nothing."""
    text = f"{round(value, 6):.1f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def pair(at):
    return f"{number(at.real)} {number(HEIGHT - at.imag)}"


def text_width(text):
    """An upper estimate, in pixels."""
    return sum(4.2 if letter in NARROW else 10.5 if letter in WIDE else 7.2 for letter in text)


class Picture:
    """The elements of one picture, in the order in which they are drawn."""

    def __init__(self, title):
        self.title, self.elements, self.labels, self.texts, self.used = title, [], [], [], set()

    def add(self, element, style):
        self.used.add(style)
        self.elements.append(f'<{element} class="{style}"/>')

    def path(self, places, style, closed=False):
        self.add(f'path d="M{"L".join(pair(p) for p in places)}{"Z" if closed else ""}"', style)

    def rings(self, rings, style):
        """A region between closed polygons: what an odd number of them surrounds."""
        self.add(f'path fill-rule="evenodd" d="{"".join("M" + "L".join(pair(p) for p in ring) + "Z" for ring in rings)}"', style)

    def line(self, a, b, style):
        self.path([a, b], style)

    def circle(self, center, radius, style):
        self.add(f'circle cx="{number(center.real)}" cy="{number(HEIGHT - center.imag)}" r="{number(radius)}"', style)

    def dot(self, at, style="dot", radius=3):
        self.circle(at, radius, style)

    def dots(self, places, style, radius):
        """Many dots in one element."""
        self.used.add(style)
        color = STYLES[style].split(";")[0].removeprefix("fill:")
        self.elements.append(f'<path d="{"".join(f"M{pair(p)}h0" for p in places)}" stroke="{color}" stroke-width="{2 * radius}" '
                             'stroke-linecap="round"/>')

    def arc(self, center, radius, begin, end, style):
        """Counter-clockwise between two angles, in radians."""
        a, b = center + cmath.rect(radius, begin), center + cmath.rect(radius, end)
        large = int((end - begin) % math.tau > math.pi)
        self.add(f'path d="M{pair(a)}A{number(radius)} {number(radius)} 0 {large} 0 {pair(b)}"', style)

    def ellipse(self, center, rx, ry, style):
        self.add(f'ellipse cx="{number(center.real)}" cy="{number(HEIGHT - center.imag)}" rx="{number(rx)}" ry="{number(ry)}"', style)

    def arrow(self, a, b, style="size", both=False):
        """A line with a head at b, or at both ends."""
        self.line(a, b, style)
        for tip, way in ((b, b - a),) + (((a, a - b),) if both else ()):
            way /= abs(way)
            self.path([tip + 6 * way * cmath.rect(1, side) for side in (math.pi - 0.45,)] + [tip] +
                      [tip + 6 * way * cmath.rect(1, math.pi + 0.45)], style)

    def text(self, at, text, style="note", anchor="start"):
        """A label whose baseline begins, has its middle or ends at a place."""
        width = text_width(text) * (1.06 if style == "note-term" else 1)
        left = at.real - {"start": 0, "middle": width / 2, "end": width}[anchor]
        box = (left, at.imag - 2.5, left + width, at.imag + 9)
        if box[0] < 3 or box[2] > WIDTH - 2 or box[1] < 3 or box[3] > HEIGHT - 3:
            raise ValueError(f'the label "{text}" leaves the picture: {box}')
        for other, its in self.labels:
            if box[0] < its[2] and its[0] < box[2] and box[1] < its[3] and its[1] < box[3]:
                raise ValueError(f'the labels "{text}" and "{other}" overlap')
        self.labels.append((text, box))
        self.used.add(style)
        place = "" if anchor == "start" else f' text-anchor="{anchor}"'
        self.texts.append(f'<text class="{style}" x="{number(at.real)}" y="{number(HEIGHT - at.imag)}"{place}>{text}</text>')

    def svg(self):
        styles = "".join(f".{name}{{{STYLES[name]}}}" for name in STYLES if name in self.used)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">\n'
                f"<title>{self.title}</title>\n<style>{styles}{TEXT}</style>\n"
                f'<rect x=".5" y=".5" width="{WIDTH - 1}" height="{HEIGHT - 1}" rx="8" fill="#fff" stroke="#ccc"/>\n' +
                "\n".join(self.elements + self.texts) + "\n</svg>\n")
