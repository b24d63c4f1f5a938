"""Voronoi diagrams."""
from __future__ import annotations

import os
import typing

import numpy

from . import _construction
from ._arrays import Anything, Floats, Indices, choice, floats, view
from ._progress import Progress

PathLike = typing.Union[str, "os.PathLike[str]"]
_NONE = 0xFFFFFFFF


class Voronoi:
    """The Voronoi diagram of points in space.

    >>> diagram = voronoi([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> diagram.vertices[diagram.finite]
    array([[0.5, 0.5, 0.5]])
    """

    def __init__(self, diagram: _construction.VoronoiDiagram, report: dict[str, typing.Any]) -> None:
        """Not for users: see voronoi() and Voronoi.load()."""
        self._diagram = diagram
        self.report = report  #: what it took to build it

    @classmethod
    def load(cls, file: PathLike) -> Voronoi:
        """Reads a .vor file of any system. MeshError names the line."""
        return cls(_construction.read_vor(os.fspath(file)), {})

    def save(self, file: PathLike) -> None:
        """Writes a .vor file."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() != ".vor":
            raise ValueError(f"{path}: a diagram is saved as .vor")
        from ._trees import _write

        _write(path, self._diagram.to_vor().encode())

    @property
    def sites(self) -> Floats:
        """The points, (n, 3)."""
        return typing.cast(Floats, view(self._diagram.sites()))

    @property
    def vertices(self) -> Floats:
        """The vertices of the cells, (k, 3); of those at infinity, the direction of the unbounded edge."""
        return typing.cast(Floats, view(self._diagram.vertices()))

    @property
    def radii(self) -> Floats:
        """The distance of each vertex to its forming sites, (k,); infinite at infinity."""
        return typing.cast(Floats, view(self._diagram.radii()))

    @property
    def finite(self) -> typing.Any:
        """Whether each vertex is not at infinity, (k,) bool."""
        return numpy.isfinite(self.radii)

    @property
    def forming_sites(self) -> typing.Any:
        """The four sites that each vertex is equally far from, (k, 4) int64; -1 stands for infinity."""
        return _signed(view(self._diagram.forming_sites()))

    @property
    def neighbors(self) -> typing.Any:
        """The four vertices next to each, (k, 4) int64."""
        return _signed(view(self._diagram.neighbors()))

    def cells(self) -> list[Indices]:
        """For each site, the vertices of its cell, ascending."""
        offsets, items = self._diagram.cells()
        return typing.cast("list[Indices]", numpy.split(view(items), view(offsets)[1:-1]))

    def faces(self) -> tuple[Indices, list[Indices]]:
        """The two sites of each face, (f, 2), and its vertices in order around it."""
        sites, offsets, items = self._diagram.faces()
        return view(sites), numpy.split(view(items), view(offsets)[1:-1])

    def inaccuracy(self, *, progress: Progress = None) -> dict[str, float]:
        """How much nearer than a cell's own site the nearest one is, mean and max over samples (dissertation 6.2.3)."""
        return self._diagram.inaccuracy(progress)

    def __repr__(self) -> str:
        return f"<Voronoi: {len(self.sites)} sites, {len(self.vertices)} vertices>"

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return voronoi, (numpy.array(self.sites),)


def voronoi(sites: Anything, *, algorithm: str = "highest-first", progress: Progress = None) -> Voronoi:
    """The Voronoi diagram of (n, 3) sites. algorithm: "highest-first" stays consistent where sites are cospherical or
    coplanar; "exact", "inagaki" and "bowyer" stand beside it."""
    diagram, report = _construction.voronoi(
        floats("sites", sites, 3), choice("algorithm", algorithm, ("highest-first", "inagaki", "bowyer", "exact")),
        progress)
    report["duplicates"] = view(report["duplicates"])
    return Voronoi(diagram, report)


def _signed(indices: Indices) -> typing.Any:
    signed = indices.astype(numpy.int64)
    signed[signed == _NONE] = -1
    return signed
