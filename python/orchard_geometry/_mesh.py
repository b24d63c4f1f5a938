"""Meshes: read, checked, repaired, wrapped, asked, sampled."""
from __future__ import annotations

import dataclasses
import math
import os
import typing
import warnings

import numpy

from . import _construction
from ._arrays import Anything, Floats, Indices, choice, floats, indices, number, view, whole
from ._duck import arrays_of
from ._errors import MeshError, RepairWarning
from ._progress import Progress

PathLike = typing.Union[str, "os.PathLike[str]"]
Ints = typing.Any

_RADIANS = math.pi / 180


@dataclasses.dataclass(frozen=True, repr=False)
class ClosestPoints:
    """The places of a surface that are nearest to n points."""

    points: Floats  #: (n, 3)
    distances: Floats  #: (n,), mesh units
    faces: Indices  #: (n,): the triangle that each is on

    def __len__(self) -> int:
        return len(self.distances)

    def __repr__(self) -> str:
        return f"<ClosestPoints of {len(self)} points>"


@dataclasses.dataclass(frozen=True, repr=False)
class SurfacePoints:
    """Points that are spread evenly over a surface."""

    points: Floats  #: (n, 3)
    faces: Indices  #: (n,): the triangle that each is on
    on_edge: typing.Any  #: (n,) bool: along edges of the shape

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        return f"<SurfacePoints: {len(self)}, {int(self.on_edge.sum())} of them on edges>"


@dataclasses.dataclass(frozen=True)
class Repair:
    """What repair() did."""

    mesh: Mesh  #: the result; the same object if nothing had to be done
    lines: list[str]  #: a sentence for each thing that was done
    solid: bool  #: whether the result has an inside
    faults: str  #: what keeps it from that
    distance: float  #: mesh units: proven, how far both surfaces are apart at most


@dataclasses.dataclass(frozen=True)
class Wrap:
    """What wrap() made."""

    mesh: Mesh
    to_input: float  #: mesh units: no point of the wrap is farther from the mesh
    from_input: float  #: no point of the mesh is farther from the wrap


class Mesh:
    """A triangle mesh, immutable and shared by threads.

    vertices: (n, 3) finite numbers. faces: (m, 3) whole numbers below n, counter-clockwise seen from outside. Other
    types and orders of numbers are converted; what is C-contiguous float64 is copied once, into C++.
    root_ball: "minimal" or "ritter", the ball around the whole that trees start from.

    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> mesh.solid, round(mesh.volume, 6)
    (True, 0.166667)
    """

    _surface: _construction.Surface
    _solid_surface: _construction.Surface | None
    _name: str

    def __init__(self, vertices: Anything, faces: Anything, *, root_ball: str = "minimal") -> None:
        places = floats("vertices", vertices, 3)
        corners = indices("faces", faces, 3, len(places))
        self._set(_construction.make_surface(places, corners, choice("root_ball", root_ball, ("minimal", "ritter"))),
                  "mesh")

    def _set(self, surface: _construction.Surface, name: str) -> None:
        self._surface, self._solid_surface, self._name = surface, None, name
        self.reading: list[str] = []  #: what load() skipped or decided in the file, a sentence each

    @classmethod
    def _of(cls, surface: _construction.Surface, name: str) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._set(surface, name)
        return mesh

    @classmethod
    def load(cls, file: PathLike, *, root_ball: str = "minimal") -> Mesh:
        """Reads .obj, .ply, .stl, .off, .vtp, .vtu, .vtk, .msh, .mesh or .meshb, as it stands. MeshError names line or
        byte, what is wrong and what to do."""
        path = os.fspath(file)
        surface, lines, _ = _construction.load(path, choice("root_ball", root_ball, ("minimal", "ritter")))
        mesh = cls._of(surface, path)
        mesh.reading = lines
        return mesh

    @classmethod
    def of(cls, thing: Anything) -> Mesh:
        """A Mesh of a mesh, a file, or an object of trimesh, Open3D, meshio, pyvista or VTK, by what it has:
        .vertices and .faces or .triangles; .points and .cells or .faces; or a pair of arrays.

        >>> Mesh.of(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])).solid
        False
        """
        if isinstance(thing, Mesh):
            return thing
        if isinstance(thing, (str, os.PathLike)):
            return cls.load(thing)
        vertices, faces = arrays_of(thing)
        return cls(vertices, faces)

    @property
    def vertices(self) -> Floats:
        """(n, 3), a view."""
        return typing.cast(Floats, view(self._surface.vertices()))

    @property
    def faces(self) -> Indices:
        """(m, 3), a view."""
        return typing.cast(Indices, view(self._surface.triangles()))

    @property
    def solid(self) -> bool:
        """Whether it has an inside: closed, manifold, oriented outward, without degenerate triangles."""
        return self._surface.solid

    @property
    def faults(self) -> str:
        """What keeps it from being solid; empty if nothing does."""
        return self._surface.faults

    @property
    def area(self) -> float:
        """Of the surface, in squared mesh units."""
        return self._surface.area

    @property
    def volume(self) -> float:
        """Of the solid, in cubic mesh units; negative if it is inside out."""
        return self._surface.volume

    @property
    def bounding_radius(self) -> float:
        """Of the ball around the mesh."""
        return self._surface.bounding_radius

    @property
    def bounding_box(self) -> tuple[Floats, Floats]:
        """The lower and the upper corner, (3,) each."""
        lower, upper = self._surface.bounding_box
        return numpy.asarray(lower), numpy.asarray(upper)

    @property
    def diagonal(self) -> float:
        """Of the bounding box."""
        lower, upper = self.bounding_box
        return float(numpy.linalg.norm(upper - lower))

    def inspect(self, *, self_intersections: bool = True) -> dict[str, typing.Any]:
        """Everything about the mesh: counts, what is wrong with it, area, volume, genus, self-intersections."""
        return _construction.inspect(self._surface, bool(self_intersections))

    def self_intersections(self) -> Indices:
        """Pairs of triangles that cut or touch each other elsewhere than in corners and edges that they share, (p, 2)."""
        return typing.cast(Indices, view(self._surface.self_intersections()))

    def repair(self, *, join: float | None = None, fill_holes: float | None = None,
               progress: Progress = None) -> Repair:
        """Makes a solid of the mesh where that is safe. join: corners of open edges up to this far apart are one;
        fill_holes: holes up to this width are filled; both in bounding radii, standard values as the command's."""
        surface, said = _construction.repair(
            self._surface, None if join is None else number("join", join, 0, 0.01),
            None if fill_holes is None else number("fill_holes", fill_holes, 0, 2), progress)
        mesh = self if surface is self._surface else Mesh._of(surface, self._name)
        return Repair(mesh, said["lines"], said["solid"], said["faults"], said["distance"])

    def wrap(self, *, alpha: float = 0.01, offset: float = 0.002, progress: Progress = None) -> Wrap:
        """A closed mesh around any triangles. Openings narrower than alpha stay closed, and it lies about `offset`
        outside; both in diagonals of the bounding box. Ctrl-C is noticed before and after the wrapping itself."""
        surface, to_input, from_input = _construction.wrap(self._surface, number("alpha", alpha, 1e-4, 0.5),
                                                           number("offset", offset, 1e-9, 0.999), progress)
        return Wrap(Mesh._of(surface, self._name), to_input, from_input)

    def clip(self, normal: Anything, offset: float) -> Mesh:
        """The part of a solid where normal . p is `offset` or more, closed by the plane. normal: (3,), of any length;
        the offset counts in it. MeshError unless the mesh is solid and something of it is left.

        >>> from orchard_geometry import box_mesh
        >>> round(box_mesh().clip([0, 0, 1], 0).volume, 6)
        4.0
        """
        self._require_solid()
        direction = floats("normal", [normal], 3)[0].tolist()
        return Mesh._of(_construction.clip(self._surface, direction, number("offset", offset, -1e300, 1e300)),
                        self._name)

    def unite(self, *, progress: Progress = None) -> Mesh:
        """The mesh with closed parts that cut each other replaced by their union; the mesh itself where none do, or
        where a part cuts itself. MeshError unless the mesh is solid.

        >>> from orchard_geometry import box_mesh
        >>> len(box_mesh().unite().faces)
        12
        """
        self._require_solid()
        united = _construction.unite(self._surface, progress)
        return self if united is None else Mesh._of(united[0], self._name)

    def closest_points(self, points: Anything, *, progress: Progress = None) -> ClosestPoints:
        """The nearest place of the surface for each of (n, 3) points.

        >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> mesh.closest_points([[0.2, 0.2, 3]]).distances
        array([3.])
        """
        found = _construction.closest(self._surface, floats("points", points, 3, single=True), False, progress)
        return ClosestPoints(view(found["points"]), view(found["distances"]), view(found["triangles"]))

    def signed_distance(self, points: Anything, *, progress: Progress = None) -> Floats:
        """The distance of (n, 3) points to the surface, NEGATIVE INSIDE the solid, (n,). (trimesh's is positive there.)
        The sign is exact, also where the surface cuts itself. MeshError unless the mesh is solid."""
        self._require_solid()
        found = _construction.closest(self._surface, floats("points", points, 3, single=True), True, progress)
        return typing.cast(Floats, view(found["distances"]))

    def contains(self, points: Anything, *, progress: Progress = None) -> typing.Any:
        """Whether (n, 3) points are inside the solid, (n,) bool. MeshError unless the mesh is solid."""
        return self.signed_distance(points, progress=progress) < 0

    def sample_surface(self, samples: int = 5000, *, edge_samples: int | None = None, iterations: int = 40,
                       seed: int = 1, relaxation: str = "automatic", cluster_angle: float | None = None,
                       crease_angle: float | None = None, progress: Progress = None) -> SurfacePoints:
        """Points that are spread evenly over the surface: random by area, relaxed, a fifth of them along edges.
        Angles in degrees. The same points for a seed, on any number of threads."""
        count = whole("samples", samples, 20, 10_000_000)
        edges = count // 5 if edge_samples is None else whole("edge_samples", edge_samples, 0, 10_000_000)
        if edges > count:
            raise ValueError("edge_samples: more than samples")
        found = _construction.sample(
            self._surface, count, edges, whole("iterations", iterations, 0, 10_000), whole("seed", seed, 0, 2**64 - 1),
            relaxation, None if cluster_angle is None else number("cluster_angle", cluster_angle, 0, 90) * _RADIANS,
            None if crease_angle is None else number("crease_angle", crease_angle, 0, 180) * _RADIANS, progress)
        return SurfacePoints(view(found["points"]), view(found["triangles"]), view(found["on_edge"]).view(numpy.bool_))

    def save(self, file: PathLike) -> None:
        """Writes .obj; every coordinate reads back as the same number."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() != ".obj":
            raise ValueError(f"{path}: a mesh is saved as .obj")
        _construction.write_obj(path, self._surface)

    def _require_solid(self) -> None:
        if not self.solid:
            raise MeshError(f"{self._name}: not a closed, consistently oriented manifold: {self.faults}; "
                            "repair() or wrap() makes one of it")

    def _solid(self, strict: bool, progress: Progress) -> _construction.Surface:
        """The surface that construction starts from: as the commands do, what is safe to repair is repaired."""
        if strict:
            self._require_solid()
            return self._surface
        if self._solid_surface is None:
            done = self.repair(progress=progress)
            if not done.solid:
                note = " (numbers count from 0)" if any(c.isdigit() for c in done.faults) else ""
                raise MeshError(f"{self._name}: no closed manifold, even after repair: {done.faults}{note}; "
                                "fill_holes of repair() fills wider holes, and wrap() makes a closed skin around it")
            if done.lines:
                warnings.warn(f"{self._name}: repaired: {'; '.join(done.lines)}", RepairWarning, stacklevel=4)
            self._solid_surface = done.mesh._surface
        return self._solid_surface

    def __repr__(self) -> str:
        kind = "solid" if self.solid else "no solid"
        return f"<Mesh: {len(self.vertices)} vertices, {len(self.faces)} triangles, {kind}>"

    def _repr_html_(self) -> str:
        rows = [("vertices", len(self.vertices)), ("triangles", len(self.faces)),
                ("solid", "yes" if self.solid else f"no: {self.faults}"), ("area", f"{self.area:.6g}"),
                ("volume", f"{self.volume:.6g}"), ("bounding radius", f"{self.bounding_radius:.6g}")]
        return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return _unpickled, (numpy.array(self.vertices), numpy.array(self.faces), self._surface.root_ball, self._name)

    def plot(self, values: Anything = None, *, axes: typing.Any = None) -> typing.Any:
        """Draws the mesh with matplotlib, coloured by a value for each face, (m,), if given; returns the axes."""
        from ._plot import plot_mesh

        return plot_mesh(self.vertices, self.faces, values, axes)

    def to_vtk(self) -> typing.Any:
        """A vtkPolyData. Needs vtk."""
        from ._vtk import polydata

        return polydata(self.vertices, self.faces)

    def to_pyvista(self) -> typing.Any:
        """The same for pyvista, where that is installed."""
        from ._vtk import wrap_pyvista

        return wrap_pyvista(self.to_vtk())


def _unpickled(vertices: Floats, faces: Indices, root_ball: str, name: str) -> Mesh:
    mesh = Mesh(vertices, faces, root_ball=root_ball)
    mesh._name = name
    return mesh


def load(file: PathLike, *, root_ball: str = "minimal") -> Mesh:
    """Reads a mesh: .obj, .ply, .stl, .off, .vtp, .vtu, .vtk, .msh, .mesh or .meshb."""
    return Mesh.load(file, root_ball=root_ball)


def inspect(mesh: Anything) -> dict[str, typing.Any]:
    """What a mesh or a file holds and what is wrong with it; see Mesh.inspect()."""
    return Mesh.of(mesh).inspect()


def repair(mesh: Anything, **options: typing.Any) -> Repair:
    """Mesh.repair() of anything that is a mesh."""
    return Mesh.of(mesh).repair(**options)


def wrap(mesh: Anything, **options: typing.Any) -> Wrap:
    """Mesh.wrap() of anything that is a mesh."""
    return Mesh.of(mesh).wrap(**options)


def closest_points(mesh: Anything, points: Anything) -> ClosestPoints:
    """Mesh.closest_points() of anything that is a mesh."""
    return Mesh.of(mesh).closest_points(points)


def signed_distance(mesh: Anything, points: Anything) -> Floats:
    """Mesh.signed_distance() of anything that is a mesh: NEGATIVE INSIDE."""
    return Mesh.of(mesh).signed_distance(points)


def contains(mesh: Anything, points: Anything) -> typing.Any:
    """Mesh.contains() of anything that is a mesh."""
    return Mesh.of(mesh).contains(points)


def sample_surface(mesh: Anything, samples: int = 5000, **options: typing.Any) -> SurfacePoints:
    """Mesh.sample_surface() of anything that is a mesh."""
    return Mesh.of(mesh).sample_surface(samples, **options)


def set_threads(count: int | None) -> None:
    """How many threads construction uses at most; None: as many as there are processors. No result depends on it."""
    _construction.set_threads(0 if count is None else whole("count", count, 1, 1024))
