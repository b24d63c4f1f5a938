"""What medial axes are made of and measured by."""
from __future__ import annotations

import dataclasses
import math
import typing

import numpy

from ._arrays import Indices, choice

Ints = typing.Any
_NONE = 0xFFFFFFFF

#: What a part of an axis is: Structure.kinds are places in this list.
KINDS = ("sheet", "seam", "border", "junction", "curve")


@dataclasses.dataclass(frozen=True, repr=False)
class Structure:
    """A medial axis taken apart where it branches: sheets of faces; seams, where three or more meet; borders; curves of
    edges without faces; and junctions, where lines end or meet."""

    kinds: typing.Any  #: (p,): the kind of each part, a place in KINDS
    cells: Indices  #: (p,): how many faces or edges it has
    vertices: list[Indices]  #: of each part, ascending
    of_face: Indices  #: (f,): the sheet of each face
    of_edge: Ints  #: (e,): the line of each edge; -1 inside sheets
    of_vertex: Ints  #: (k,): a junction, or the line, or else the sheet, that the vertex is inside of

    def count(self, kind: str) -> int:
        """How many parts are of a kind."""
        return int((self.kinds == KINDS.index(choice("kind", kind, KINDS))).sum())

    def __repr__(self) -> str:
        return "<Structure: " + ", ".join(f"{self.count(kind)} {kind}s" for kind in KINDS) + ">"


@dataclasses.dataclass(frozen=True)
class Arc:
    """A line of a structure graph."""

    start: int  #: a vertex of the axis: a node
    end: int
    kind: str  #: curve, border or seam, where three or more sheets meet
    length: float  #: mesh units
    mean_radius: float
    vertices: Indices  #: of the axis, ends included


@dataclasses.dataclass(frozen=True, repr=False)
class StructureGraph:
    """The lines of an axis: borders of sheets, seams of three or more, and curves."""

    nodes: Indices  #: vertices of the axis
    arcs: list[Arc]

    def __repr__(self) -> str:
        return f"<StructureGraph: {len(self.nodes)} nodes, {len(self.arcs)} arcs>"


@dataclasses.dataclass(frozen=True, repr=False)
class Quality:
    """How good an axis is. Measures have the names and units of the command line's table; those that are not defined
    for the axis are missing."""

    measures: dict[str, float]
    units: dict[str, str]
    diagonal: float  #: of the mesh's bounding box, in mesh units
    worst: list[dict[str, typing.Any]]  #: places: kind, value in % of the diagonal, position

    def __getitem__(self, name: str) -> float:
        return self.measures[name]

    def __repr__(self) -> str:
        most = self.measures.get("hausdorff_max", math.nan)
        return f"<Quality: {len(self.measures)} measures, hausdorff_max {most:.4g} % of the diagonal>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{name}</td><td>{value:.5g}</td><td>{self.units[name]}</td></tr>"
                       for name, value in self.measures.items())
        return "<table><tr><th>measure</th><th>value</th><th>unit</th></tr>" + rows + "</table>"


def signed(array: Indices) -> Ints:
    """Where 2^32 - 1 stands for none: -1."""
    result = array.astype(numpy.int64)
    result[result == _NONE] = -1
    return result
