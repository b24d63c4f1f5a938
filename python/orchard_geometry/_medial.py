"""Medial axes."""
from __future__ import annotations

import math
import os
import typing

import numpy

from . import _construction
from ._applications import Skeleton, SurfaceParts, parts_of, skeleton_of
from ._arrays import Anything, Floats, Indices, choice, floats, indices, number, view, whole
from ._axis_files import write_axis
from ._axis_parts import KINDS, Arc, Quality, StructureGraph, Structure, signed
from ._errors import MeshError
from ._mesh import Mesh
from ._progress import Progress
from ._thickness import Thickness, thickness
from ._tuning import keyword, tuning_of

PathLike = typing.Union[str, "os.PathLike[str]"]
Ints = typing.Any
_RADIANS = math.pi / 180

class MedialAxis:
    """A medial axis of a solid as balls, and edges and triangles between them: a medial mesh.

    Arrays are views of what C++ owns. Lengths are in mesh units.
    """

    _axis: _construction.MedialAxis

    def __init__(self, axis: _construction.MedialAxis, mesh: Mesh, report: dict[str, typing.Any]) -> None:
        """Not for users: see medial_axis(), MedialAxis.load() and MedialAxis.of()."""
        self._axis = axis
        self.mesh = mesh  #: the mesh that it is of
        self.report = report  #: what building or simplifying it did, by name

    @classmethod
    def load(cls, file: PathLike, mesh: Anything, *, connect: bool = False) -> MedialAxis:
        """The axis of a file of any system, in the frame of the mesh: .ma, .ma_dup, .ma_struct, .obj, .ply, .off, .sph,
        .swc, .cg, .cgal, .txt, .xyz, .xyzr, .balls. Missing radii are distances to the surface. connect: balls without
        cells are connected by their power diagram within the solid. `report["notes"]` says what was decided."""
        solid = Mesh.of(mesh)
        axis = _construction.read_axis(solid._solid(False, None), os.fspath(file), bool(connect))
        return cls(axis, solid, {"notes": axis.notes()})

    @classmethod
    def of(cls, mesh: Anything, vertices: Anything, radii: Anything, edges: Anything = (),
           faces: Anything = ()) -> MedialAxis:
        """An axis of any system from arrays: vertices (k, 3), radii (k,), edges (e, 2), faces (f, 3). The edges of
        faces need not be given."""
        solid = Mesh.of(mesh)
        centers, sizes = floats("vertices", vertices, 3), floats("radii", radii, 0)
        if len(sizes) != len(centers):
            raise ValueError(f"radii: expected {len(centers)} of them, not {len(sizes)}")
        if not len(centers):
            raise ValueError("vertices: there is none")
        axis = _construction.axis_of_arrays(solid._solid(False, None), centers, sizes,
                                            indices("edges", edges, 2, len(centers)),
                                            indices("faces", faces, 3, len(centers)))
        return cls(axis, solid, {})

    @property
    def vertices(self) -> Floats:
        """The centres of the balls, (k, 3)."""
        return typing.cast(Floats, view(self._axis.vertices()))

    @property
    def radii(self) -> Floats:
        """(k,)."""
        return typing.cast(Floats, view(self._axis.radii()))

    @property
    def edges(self) -> Indices:
        """All edges, those of faces included, (e, 2), ascending."""
        return typing.cast(Indices, view(self._axis.edges()))

    @property
    def faces(self) -> Indices:
        """The triangles, (f, 3), each ascending."""
        return typing.cast(Indices, view(self._axis.faces()))

    @property
    def features(self) -> Indices:
        """Edges of the mesh that sheets reach to, by its vertices, (n, 2); of a refined axis that was built here."""
        return typing.cast(Indices, view(self._axis.features()))

    @property
    def points(self) -> Floats:
        """The surface points that it was built from, (n, 3); none of an axis that was not built here."""
        return typing.cast(Floats, view(self._axis.points()))

    @property
    def structure(self) -> Structure:
        """Sheets, seams, borders, junctions and curves."""
        found = self._axis.structure()
        return Structure(view(found["kinds"]), view(found["cells"]), [view(part) for part in found["vertices"]],
                         view(found["of_face"]), signed(view(found["of_edge"])), signed(view(found["of_vertex"])))

    @property
    def contact_angle(self) -> Floats:
        """The angle in radians between the two contacts of each ball that are seen farthest apart, (k,): what is near
        pi lies between two opposite sides, small angles are spurs. NaN where it is not known, as of an axis that was read."""
        return typing.cast(Floats, view(self._axis.vertex_angles()))

    def importance(self, *measures: str, progress: Progress = None) -> dict[str, Floats]:
        """Measures of each ball to threshold or colour by, (k,) each: contact_angle in radians; radius; radius_error and
        protrusion in mesh units. measures: some of "border_loss", "lambda", "erosion" and "geodesic", in mesh units, and
        "scale", a factor, of how much each ball of an axis that was built here matters; infinite where it always does,
        NaN for the middles of faces of a raw axis. "geodesic" takes longest."""
        errors = self.ball_errors()
        chosen = [choice("measures", measure, ("border_loss", "lambda", "scale", "erosion", "geodesic"))
                  for measure in measures]
        more = _construction.importance(self._axis, chosen, progress) if chosen else {}
        return {"contact_angle": self.contact_angle, "radius": self.radii, **errors,
                **{name: view(values) for name, values in more.items()}}

    def ball_errors(self, *, centredness: bool = False) -> dict[str, Floats]:
        """What is wrong with each ball, (k,): radius_error and protrusion out of the solid in mesh units; centredness
        over the radius, which takes longest."""
        found = _construction.ball_errors(self._axis, bool(centredness))
        diagonal = self.mesh.diagonal
        return {name: view(values) * (1 if name == "centredness" else diagonal) for name, values in found.items()}

    def quality(self, *, samples: int = 100_000, seed: int = 1, stability: bool = False,
                progress: Progress = None) -> Quality:
        """How good the axis is, by every measure of the command line's --report. samples: surface points; fewer are
        faster and miss more of the largest errors. stability: build another axis of the mesh with noise, and compare."""
        found = _construction.quality(self._axis, whole("samples", samples, 100, 10_000_000),
                                      whole("seed", seed, 0, 2**64 - 1), bool(stability), progress)
        return Quality(found["measures"], found["units"], found["diagonal"], found["worst"])

    def topology(self) -> dict[str, int]:
        """Its components, loops and cavities."""
        return _construction.axis_topology(self._axis)

    def simplify(self, vertices: int | None = None, *, error: float | None = None, balls: str = "medial", seed: int = 1,
                 progress: Progress = None) -> MedialAxis:
        """The axis in at most so many balls, or in as few as are off by no more than `error` percent of the diagonal.
        balls: "medial" keeps centres in the solid; "free" may come nearer where they are few. `report` says how far
        off it is, in percent of the diagonal."""
        if (vertices is None) == (error is None):
            raise ValueError("simplify: give a number of vertices or an error, and not both")
        few, said = _construction.simplify(
            self._axis, 0 if vertices is None else whole("vertices", vertices, 1, 100_000_000),
            0 if error is None else number("error", error, 1e-4, 100) / 100,
            choice("balls", balls, ("medial", "free")) == "free", whole("seed", seed, 0, 2**64 - 1), progress)
        return MedialAxis(few, self.mesh, said)

    def prune(self, *, angle: float = 0, scale: float = 1, border_loss: float = 0, lambda_: float = 0,
              erosion: float = 0, geodesic: float = 0, samples: int = 5000, seed: int = 1,
              progress: Progress = None) -> MedialAxis:
        """The axis without what is insignificant by a measure: angle in degrees removes places whose contacts are seen
        nearer to each other, scale removes balls that others contain when all are so many times larger; the others are
        those of importance(), in percent of the diagonal. The topology stays. An axis that was not built here gets its
        contacts from `samples` points of the surface."""
        limits = {"angle": number("angle", angle, 0, 180) * _RADIANS, "scale": number("scale", scale, 1, 10),
                  "border_loss": number("border_loss", border_loss, 0, 100) / 100,
                  "lambda": number("lambda_", lambda_, 0, 100) / 100,
                  "erosion": number("erosion", erosion, 0, 100) / 100,
                  "geodesic": number("geodesic", geodesic, 0, 400) / 100}
        pruned = _construction.prune(self._axis, limits, whole("samples", samples, 20, 10_000_000),
                                     whole("seed", seed, 0, 2**64 - 1), progress)
        return MedialAxis(pruned, self.mesh, {})

    def thickness(self, points: Anything = None, **options: typing.Any) -> Thickness:
        """How thick the solid is: see thickness()."""
        return thickness(self.mesh, points, **options)

    def skeleton(self, *, erosion: float = 1, ratio: float = 0.35, edge: float = 0.75, straighten: int = 20,
                 progress: Progress = None) -> Skeleton:
        """The axis reduced to curves, with the loops, parts and cavities that it has. erosion: the smallest significance
        of a branch, in percent of the diagonal; ratio: the smallest rate at which it grows; edge: the longest edge, in
        percent of the diagonal; straighten: rounds in which curves are straightened.

        >>> from orchard_geometry import box_mesh
        >>> len(medial_axis(box_mesh([1, 2, 4]), samples=800).skeleton().curves)
        1
        """
        return skeleton_of(self._axis, erosion, ratio, edge, straighten, progress)

    def segment(self, *, by: str = "both", neck: float = 0.2, min_area: float = 0.2, faces: int = 20_000,
                seam_rounds: int = 5, progress: Progress = None) -> SurfaceParts:
        """The surface divided by the sheets of the axis ("sheets"), at its necks ("necks"), or by sheets that are cut at
        necks ("both"). neck: the smallest significance of a neck; min_area: the smallest patch, in percent of the
        surface; faces: about how many the surface is divided into; seam_rounds: in which seams are smoothed."""
        return parts_of(self._axis, by, neck, min_area, faces, seam_rounds, progress)

    def structure_graph(self) -> StructureGraph:
        """The lines of the axis as a graph."""
        found = self._axis.structure_graph()
        arcs = [Arc(arc["from"], arc["to"], arc["kind"], arc["length"], arc["mean_radius"], view(arc["vertices"]))
                for arc in found["arcs"]]
        return StructureGraph(view(found["nodes"]), arcs)

    def envelope(self, cell: float = 0.5, *, progress: Progress = None) -> Mesh:
        """The surface of what the axis stands for, the union of its balls, cones and slabs. cell: percent of the
        diagonal; what is thinner may be lost."""
        surface, _ = _construction.envelope(self._axis, number("cell", cell, 0.01, 50) / 100, progress)
        return Mesh._of(surface, "envelope")

    def distance(self, other: MedialAxis, *, accuracy: float | None = None) -> dict[str, float]:
        """How far two axes are apart as sets of centres, in mesh units: max (two-sided Hausdorff) and max_gap, by how
        much more it may be; mean; max_from and max_to, one-sided. accuracy: to which the maximum is searched."""
        if not isinstance(other, MedialAxis):
            raise TypeError(f"other: expected a MedialAxis, not {type(other).__name__}")
        wanted = 1e-4 * self.mesh.diagonal if accuracy is None else number("accuracy", accuracy, 1e-300, math.inf)
        return _construction.axis_distance(self._axis, other._axis, wanted)

    def save(self, file: PathLike) -> None:
        """Writes .ma (the same bytes as the command), .ply, .obj, .graphml (the structure graph), .off, .sph, .cg, .txt,
        .xyz, .xyzr or .balls. What a format has no place for is left out: radii of .obj, .off and .cg, cells of balls."""
        path = os.fspath(file)
        ending = os.path.splitext(path)[1].lower()
        if ending in (".ma", ".ma_struct", ".ply", ".obj", ".graphml"):
            self._axis.save(path, "ma" if ending == ".ma_struct" else ending[1:])
        else:
            write_axis(self, path, ending)

    def __len__(self) -> int:
        return len(self.radii)

    def __repr__(self) -> str:
        return f"<MedialAxis: {len(self)} balls, {len(self.edges)} edges, {len(self.faces)} faces>"

    def _repr_html_(self) -> str:
        structure = self.structure
        rows: list[tuple[str, object]] = [("balls", len(self)), ("edges", len(self.edges)), ("faces", len(self.faces))]
        rows += [(f"{kind}s", structure.count(kind)) for kind in KINDS]
        rows += [("radii", f"{self.radii.min():.4g} to {self.radii.max():.4g}")]
        return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"

    def __reduce__(self) -> tuple[typing.Any, ...]:
        state = tuple(numpy.array(values) for values in (self.vertices, self.radii, self.edges, self.faces))
        return _unpickled, (self.mesh, state, self.report)

    def plot(self, values: Anything = None, *, axes: typing.Any = None) -> typing.Any:
        """Draws faces and edges with matplotlib, coloured by a value for each ball, (k,), or else by radius; returns the
        axes."""
        from ._plot import plot_axis

        return plot_axis(self, self.radii if values is None else values, axes)

    def to_vtk(self) -> typing.Any:
        """A vtkPolyData of faces and edges with arrays radius, contact_angle, structure and structure_kind. Needs vtk."""
        from ._vtk import axis_to_vtk

        return axis_to_vtk(self)

    def to_pyvista(self) -> typing.Any:
        """The same for pyvista, where that is installed."""
        from ._vtk import wrap_pyvista

        return wrap_pyvista(self.to_vtk())


def _unpickled(mesh: Mesh, state: typing.Any, report: dict[str, typing.Any]) -> MedialAxis:
    axis = MedialAxis.of(mesh, *state)
    axis.report = report
    return axis


def medial_axis(
    mesh: Anything,
    *,
    samples: int | None = None,
    edge_samples: int | None = None,
    relaxation: str | None = None,
    iterations: int | None = None,
    cluster_angle: float | None = None,
    crease_angle: float | None = None,
    seed: int | None = None,
    algorithm: str | None = None,
    gaps: str | None = None,
    joined_radius: float | None = None,
    max_passes: int | None = None,
    thin: bool | None = None,
    coalesce: float | None = None,
    topology: str | None = None,
    prune_angle: float | None = None,
    prune_scale: float | None = None,
    prune_border_loss: float | None = None,
    prune_lambda: float | None = None,
    prune_erosion: float | None = None,
    prune_geodesic: float | None = None,
    refine: bool | None = None,
    border_loss: float | None = None,
    linear_error: float | None = None,
    reach_rounds: int | None = None,
    feature_loss: float | None = None,
    edge_length: float | None = None,
    open_rounds: int | None = None,
    features: Anything = None,
    points: Anything = None,
    side: str = "inside",
    outside_radius: float = 2,
    strict: bool = False,
    check_promise: bool = True,
    progress: Progress = None,
) -> MedialAxis:
    """The medial axis of a solid: of a Mesh, a file, or a mesh of another library.

    Every option of `orchard medial` is a keyword, in its units, and has its standard value unless it is given;
    tuning_options() lists them with what they trade. Lengths are percent of the diagonal, angles degrees.

    samples: surface points (5000); more follow the shape better. border_loss (0.1): more cuts more spurs off.
    feature_loss (0.165): sheets reach to edges beyond which so much is lost. edge_length (3): of the axis' triangles.
    refine=False: the axis as the diagram has it. features: edges of the mesh by its vertices, (n, 2), that sheets reach
    to. points: your own surface points, (n, 3). side: "outside" is the space around the solid, within a sphere of
    outside_radius bounding radii. strict: a mesh that is no solid is refused; else what is safe to repair is repaired,
    with a RepairWarning. check_promise: compare the result with what is promised of it.

    The same bits as the command with the same options, whatever the number of threads.

    >>> axis = medial_axis(box_mesh(), samples=200)
    >>> axis.vertices.shape[1], axis.topology()["components"]
    (3, 1)
    """
    tuning = tuning_of(
        samples=samples, edge_samples=edge_samples, relaxation=relaxation, iterations=iterations,
        cluster_angle=cluster_angle, crease_angle=crease_angle, seed=seed, algorithm=algorithm, gaps=gaps,
        joined_radius=joined_radius, max_passes=max_passes, thin=thin, coalesce=coalesce, topology=topology,
        prune_angle=prune_angle, prune_scale=prune_scale, prune_border_loss=prune_border_loss,
        prune_lambda=prune_lambda, prune_erosion=prune_erosion, prune_geodesic=prune_geodesic, refine=refine, border_loss=border_loss,
        linear_error=linear_error, reach_rounds=reach_rounds, feature_loss=feature_loss, edge_length=edge_length,
        open_rounds=open_rounds)
    outside = choice("side", side, ("inside", "outside")) == "outside"
    if outside and points is not None:
        raise ValueError("points has no effect with side='outside'")
    solid = Mesh.of(mesh)
    surface = solid._solid(bool(strict), progress)
    own = None if points is None else floats("points", points, 3)
    edges = None if features is None else indices("features", features, 2, len(view(surface.vertices())))
    axis, report = _construction.medial_axis(surface, tuning, own, edges, outside,
                                             number("outside_radius", outside_radius, 1.1, 1000), bool(check_promise),
                                             progress)
    report["notes"] = []
    return MedialAxis(axis, solid, report)


def tuning_options() -> dict[str, dict[str, typing.Any]]:
    """Every tuning option of medial_axis(): what it trades, its standard value, its range or its choices.

    >>> tuning_options()["border_loss"]["standard"]
    '0.1'
    """
    table = _construction.tuning_table()
    return {keyword(row["name"]): {name: value for name, value in row.items() if name != "name"}
            for row in table if row["name"] != "segment-angle"}


def box_mesh(half_lengths: Anything = (1, 1, 1)) -> Mesh:
    """A box around the origin as a mesh of 12 triangles: for examples and tests.

    >>> box_mesh().volume
    8.0
    """
    half = floats("half_lengths", half_lengths, 0)
    if half.shape != (3,) or not (half > 0).all():
        raise ValueError("half_lengths: expected three numbers above 0")
    corners = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    return Mesh(corners, [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
                          [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


__all__ = ["Arc", "KINDS", "MedialAxis", "MeshError", "Quality", "StructureGraph", "Structure", "box_mesh",
           "medial_axis", "tuning_options"]
