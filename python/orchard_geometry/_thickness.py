"""The local thickness of a solid."""
from __future__ import annotations

import dataclasses
import math
import typing

from . import _construction
from ._arrays import Anything, Floats, Indices, choice, floats, number, view, whole
from ._mesh import Mesh
from ._progress import Progress

_RADIANS = math.pi / 180


@dataclasses.dataclass(frozen=True, repr=False)
class Thickness:
    """How thick a solid is at n places, in mesh units."""

    thickness: Floats  #: (n,): NaN where nothing faces the place, as beside edges
    ball_diameter: Floats  #: (n,): of the largest ball in the solid that touches the place; 0 on edges that stick out
    error: Floats  #: (n,): proven, diameter and thickness are too large by no more; inf: a thickness may be missing
    contact: Floats  #: (n, 3): the other end
    contact_angle: Floats  #: (n,): radians between both ends

    def __len__(self) -> int:
        return len(self.thickness)

    def __repr__(self) -> str:
        return f"<Thickness at {len(self)} places>"


@dataclasses.dataclass(frozen=True, repr=False)
class ThinPlaces:
    """Where a solid is thinner than a limit."""

    area: float  #: of all thin faces, in squared mesh units
    defined_area: float  #: of all faces whose thickness is defined
    total_area: float
    regions: list[dict[str, typing.Any]]  #: the largest first: area, min_thickness, thinnest (a place), faces
    of_face: typing.Any  #: (m,) int64: the region of each face of the thickness' mesh; -1: none

    def __repr__(self) -> str:
        return f"<ThinPlaces: {len(self.regions)} regions, area {self.area:.4g} of {self.total_area:.4g}>"


@dataclasses.dataclass(frozen=True, repr=False)
class LocalThickness:
    """The thickness of a whole solid, at the corners and middles of a mesh whose long edges are divided."""

    mesh: Mesh  #: the vertices of the solid's own mesh come first
    of_face: Indices  #: (m,): the solid's triangle that each face is a part of
    at_vertices: Thickness
    at_faces: Thickness
    _handle: _construction.LocalThickness

    def thin_places(self, below: float) -> ThinPlaces:
        """The connected regions of faces that are thinner than a limit, in mesh units."""
        found = _construction.thin_places(self._handle, number("below", below, 0, math.inf))
        of_face = view(found.pop("of_face")).astype("int64")
        of_face[of_face == 0xFFFFFFFF] = -1
        return ThinPlaces(of_face=of_face, **found)

    def plot(self, *, axes: typing.Any = None) -> typing.Any:
        """Draws the mesh coloured by thickness with matplotlib; returns the axes."""
        return self.mesh.plot(self.at_faces.thickness, axes=axes)

    def to_vtk(self) -> typing.Any:
        """A vtkPolyData with the arrays thickness and ball_diameter of vertices and faces. Needs vtk."""
        from ._vtk import thickness_to_vtk

        return thickness_to_vtk(self)

    def __repr__(self) -> str:
        return f"<LocalThickness: {len(self.at_vertices)} vertices, {len(self.at_faces)} faces>"


def _values(found: dict[str, typing.Any]) -> Thickness:
    return Thickness(*(view(found[name]) for name in ("thickness", "ball_diameter", "error", "contact",
                                                      "contact_angle")))


def thickness(mesh: Anything, points: Anything = None, *, definition: str = "ball", facing: float = 120,
              smooth: float = 40, strict: bool = False, progress: Progress = None) -> Thickness:
    """How thick a solid is at the places of its surface that are nearest to (n, 3) points; at its vertices, if none are
    given. definition: the diameter of the largest ball in the solid that touches the place ("ball"), or the way of a
    ray inward ("ray"). facing: degrees from which two ends face each other. smooth: edges that turn by less are those
    of a smooth surface.

    >>> from orchard_geometry import box_mesh
    >>> float(thickness(box_mesh([1, 1, 0.25]), [[0, 0, 0.25]]).thickness[0].round(9))
    0.5
    """
    solid = Mesh.of(mesh)
    places = solid.vertices if points is None else floats("points", points, 3, single=True)
    return _values(_construction.thickness_at(
        solid._solid(strict, progress), places, choice("definition", definition, ("ball", "ray")),
        number("facing", facing, 0, 180) * _RADIANS, number("smooth", smooth, 0.01, 90) * _RADIANS, progress))


def local_thickness(mesh: Anything, *, samples: int = 20_000, definition: str = "ball", facing: float = 120,
                    smooth: float = 40, strict: bool = False, progress: Progress = None) -> LocalThickness:
    """The thickness of a whole solid. samples: triangles that the surface is divided into, about; others as
    thickness()."""
    solid = Mesh.of(mesh)
    found = _construction.thickness(
        solid._solid(strict, progress), choice("definition", definition, ("ball", "ray")),
        number("facing", facing, 0, 180) * _RADIANS, number("smooth", smooth, 0.01, 90) * _RADIANS,
        whole("samples", samples, 1, 100_000_000), progress)
    return LocalThickness(Mesh(view(found["vertices"]), view(found["faces"])), view(found["of_face"]),
                          _values(found["at_vertices"]), _values(found["at_faces"]), found["handle"])
