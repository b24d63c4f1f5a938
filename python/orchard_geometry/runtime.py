"""Sphere-trees and collision answers: orchard's run-time. It is under the MIT licence and needs nothing else of orchard.

Trees come from `orchard build`, from orchard_geometry.sphere_tree(), or from a few simple shapes. All questions take
many poses at once, run without the GIL, and only read the trees, which any number of threads may share.

A pose is a row of 7 numbers, tx ty tz qw qx qy qz as on the command line (quaternion="xyzw": tx ty tz qx qy qz qw), or
a 4 x 4 matrix with the translation in its last column. Quaternions have length 1; others are refused.
"""
from __future__ import annotations

import dataclasses
import enum
import math
import os
import typing

import numpy
import numpy.typing

from . import _runtime
from ._arrays import Anything, Floats, choice, floats, indices, number, view, whole

__all__ = ["Answer", "BroadPhase", "Change", "Collisions", "Contacts", "Detector", "Distances", "Event", "Frame",
           "Impacts", "NearestPoints", "RayHits", "Tree", "WorldPoint", "cast_rays", "closer_than", "collide",
           "contacts", "contains", "distance", "load", "nearest_points", "time_of_impact"]
__version__: str = _runtime.version

Ints = numpy.typing.NDArray[numpy.int64]
Bytes = numpy.typing.NDArray[numpy.uint8]
Bools = numpy.typing.NDArray[numpy.bool_]
PathLike = typing.Union[str, "os.PathLike[str]"]

_NONE = 0xFFFFFFFF
_IDENTITY = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


class Answer(enum.IntEnum):
    """What is certain about a pair of surfaces."""

    NO = 0  #: they do not touch
    MAYBE = 1  #: nothing excludes it so far; bounds say how far apart they may be
    YES = 2  #: a triangle of one meets a triangle of the other


def _flags(mask: typing.Any) -> Bools:
    return numpy.asarray(mask, dtype=numpy.bool_)


def _poses(name: str, value: Anything) -> Floats:
    """(k, 7), (7,), (k, 4, 4) or (4, 4) as (k, 7) or (k, 16)."""
    array = numpy.asarray(value)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: expected numbers, not {array.dtype}")
    if array.shape == (4, 4) or array.shape == (7,):
        array = array[numpy.newaxis]
    if array.ndim == 3 and array.shape[1:] == (4, 4):
        array = array.reshape(len(array), 16)
    elif array.ndim != 2 or array.shape[1] != 7:
        raise ValueError(f"{name}: expected the shape (k, 7) or (k, 4, 4), not {numpy.asarray(value).shape}")
    return numpy.ascontiguousarray(array, dtype=numpy.float64)


def _wxyz(quaternion: str) -> bool:
    return choice("quaternion", quaternion, ("wxyz", "xyzw")) == "wxyz"


def _triangles(a: typing.Any, b: typing.Any) -> Ints:
    both: Ints = numpy.stack([a, b], axis=1).astype(numpy.int64)
    both[both == _NONE] = -1
    return both


class Tree:
    """A certified sphere-tree as it ships: float spheres, rounded outward, with the triangles that they cover.

    Nodes are numbered level by level, the root first. Nothing of a tree changes, so any number of threads may use it.

    >>> box = Tree.box([1, 1, 1])
    >>> box.depth, box.spheres(0).shape
    (0, (1, 4))
    """

    _tree: _runtime.Tree

    def __init__(self, tree: _runtime.Tree) -> None:
        """Not for users: see load(), from_bytes(), box(), hull(), of_triangles() and orchard_geometry.sphere_tree()."""
        self._tree = tree

    @classmethod
    def load(cls, file: PathLike) -> Tree:
        """The tree of an .orchard file. ValueError, as the command line says it, if it is none."""
        return cls(_runtime.Tree.load(os.fspath(file)))

    @classmethod
    def from_bytes(cls, data: bytes) -> Tree:
        """The tree of the bytes of an .orchard file: of a database, a network, another process."""
        return cls(_runtime.Tree.from_bytes(data))

    @classmethod
    def box(cls, half_lengths: Anything) -> Tree:
        """A box around the origin; half the lengths of its edges, (3,), above 0."""
        half = floats("half_lengths", half_lengths, 0)
        if half.shape != (3,) or not (half > 0).all():
            raise ValueError("half_lengths: expected three numbers above 0")
        return cls(_runtime.Tree.of_box(half.tolist()))

    @classmethod
    def hull(cls, points: Anything) -> Tree:
        """The convex hull of points, (n, 3)."""
        return cls(_runtime.Tree.of_hull(floats("points", points, 3)))

    @classmethod
    def of_triangles(cls, vertices: Anything, faces: Anything) -> Tree:
        """A few dozen triangles as they are: vertices (n, 3), faces (m, 3). The spheres' bounds are unknown. For meshes
        there is orchard_geometry.sphere_tree()."""
        places = floats("vertices", vertices, 3)
        corners = indices("faces", faces, 3, len(places))
        if not len(corners):
            raise ValueError("faces: there is none")
        return cls(_runtime.Tree.of_triangles(places, corners))

    def to_bytes(self) -> bytes:
        """The bytes of its .orchard file: the same for the same tree on every machine."""
        return self._tree.to_bytes()

    def save(self, file: PathLike) -> None:
        """Writes an .orchard file, as a whole or not at all."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() != ".orchard":
            raise ValueError(f"{path}: a tree is saved as .orchard")
        _write(path, self.to_bytes())

    def spheres(self, level: int | None = None, *, complete: bool = False) -> Floats:
        """The spheres x y z r of a level, (k, 4), or of all nodes. The root is level 0, -1 the last level. `complete`
        adds the leaves of the levels above, so that together they hold the whole surface."""
        everything: Floats = view(self._tree.spheres())
        if level is None:
            return everything
        wanted = self.depth + 1 + level if level < 0 else level
        if not 0 <= wanted <= self.depth:
            raise ValueError(f"level: {level} is not between 0 and {self.depth}")
        first, last = numpy.searchsorted(self.levels, [wanted, wanted + 1])
        if not complete:
            return everything[first:last]
        return typing.cast(Floats, everything[(self.levels == wanted) | (self.leaves & (self.levels < wanted))])

    @property
    def parents(self) -> Ints:
        """The node above each node, (n,); -1 of the root."""
        return typing.cast(Ints, view(self._tree.parents()))

    @property
    def levels(self) -> numpy.typing.NDArray[numpy.int32]:
        """The level of each node, (n,), ascending."""
        return typing.cast("numpy.typing.NDArray[numpy.int32]", view(self._tree.levels()))

    @property
    def leaves(self) -> Bools:
        """Whether each node has no children, (n,)."""
        return typing.cast(Bools, view(self._tree.leaves()).view(numpy.bool_))

    @property
    def errors(self) -> Floats:
        """Upper bound on the distance from any point of each sphere to the solid, (n,), in mesh units; infinite where
        nothing is known."""
        return typing.cast(Floats, view(self._tree.errors()))

    @property
    def depths(self) -> Floats:
        """Upper bound on the signed distance of each centre, negative inside the solid, (n,), in mesh units."""
        return typing.cast(Floats, view(self._tree.depths()))

    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float32]:
        """The vertices of its triangles relative to `origin`, (v, 3)."""
        return typing.cast("numpy.typing.NDArray[numpy.float32]", view(self._tree.vertices()))

    @property
    def faces(self) -> numpy.typing.NDArray[numpy.uint32]:
        """Its triangles, (m, 3), into `vertices`."""
        return typing.cast("numpy.typing.NDArray[numpy.uint32]", view(self._tree.triangles()))

    @property
    def origin(self) -> tuple[float, float, float]:
        """What `vertices` are relative to, in the mesh's frame."""
        x, y, z = self._tree.origin
        return x, y, z

    @property
    def depth(self) -> int:
        """Levels below the root."""
        return self._tree.depth

    @property
    def branching(self) -> int:
        """No node has more children."""
        return self._tree.branching

    @property
    def bounding_radius(self) -> float:
        """Of the mesh, in mesh units."""
        return self._tree.bounding_radius

    def __len__(self) -> int:
        return len(view(self._tree.parents()))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self)} spheres, depth {self.depth}, {len(self.faces)} triangles>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{level}</td><td>{len(self.spheres(level))}</td><td>{_max(self, level)}</td></tr>"
                       for level in range(self.depth + 1))
        return ("<table><caption>" + repr(self)[1:-1] + "</caption><tr><th>level</th><th>spheres</th>"
                "<th>distance bound, max</th></tr>" + rows + "</table>")

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return type(self).from_bytes, (self.to_bytes(),)

    def plot(self, level: int = -1, *, axes: typing.Any = None) -> typing.Any:
        """Draws the spheres of a level with matplotlib; returns the axes."""
        from ._plot import plot_spheres

        return plot_spheres(self.spheres(level, complete=True), axes)

    def to_vtk(self, level: int | None = None) -> typing.Any:
        """A vtkPolyData of the spheres' centres with arrays radius, error, level and parent. Needs vtk."""
        from ._vtk import tree_to_vtk

        return tree_to_vtk(self, level)

    def to_pyvista(self, level: int | None = None) -> typing.Any:
        """The same for pyvista, where that is installed."""
        from ._vtk import wrap_pyvista

        return wrap_pyvista(self.to_vtk(level))


def _max(tree: Tree, level: int) -> str:
    return f"{float(tree.errors[tree.levels == level].max()):.4g}"


def _write(path: str, data: bytes) -> None:
    part = f"{path}.{os.getpid()}.part"
    try:
        with open(part, "wb") as file:
            file.write(data)
        os.replace(part, path)
    except OSError:
        if os.path.exists(part):
            os.remove(part)
        raise


def load(file: PathLike) -> Tree:
    """The tree of an .orchard file."""
    return Tree.load(file)


def _of(tree: object, name: str) -> _runtime.Tree:
    if not isinstance(tree, Tree):
        raise TypeError(f"{name}: expected a Tree, not {type(tree).__name__}")
    return tree._tree


def _limits(work: int | None, seconds: float | None) -> tuple[int, float]:
    return (0 if work is None else whole("work", work, 1, 2**63 - 1),
            math.inf if seconds is None else number("seconds", seconds, 0, 1e9))


@dataclasses.dataclass(frozen=True, repr=False)
class Collisions:
    """The answers at k poses. Arrays are views of what C++ owns."""

    answers: Bytes  #: (k,), each an Answer
    separation_bounds: Floats  #: (k,): the solids are no farther apart; infinite where unknown
    lower_bounds: Floats  #: (k,): the surfaces are no nearer; 0 where unknown
    points: Floats  #: (k, 3), world: of a yes a common point, of a maybe the middle of where spheres meet
    normals: Floats  #: (k, 3): from a to b, a guess
    triangles: Ints  #: (k, 2): that meet, of a and of b; -1 without a yes
    levels: numpy.typing.NDArray[numpy.uint32]  #: (k,): levels that were completed
    work: numpy.typing.NDArray[numpy.uint64]  #: (k,): as a budget counts it

    @property
    def touching(self) -> Bools:
        """(k,): whether the surfaces touch, which is certain."""
        return _flags(self.answers == Answer.YES)

    @property
    def apart(self) -> Bools:
        """(k,): whether the surfaces do not touch, which is certain."""
        return _flags(self.answers == Answer.NO)

    def __len__(self) -> int:
        return len(self.answers)

    def __repr__(self) -> str:
        counts = [int((self.answers == answer).sum()) for answer in (Answer.YES, Answer.NO, Answer.MAYBE)]
        return "<Collisions at {} poses: {} yes, {} no, {} maybe>".format(len(self), *counts)


def collide(tree_a: Tree, tree_b: Tree, poses: Anything, *, poses_a: Anything = None, quaternion: str = "wxyz",
            work: int | None = None, seconds: float | None = None, order: str = "exact_first") -> Collisions:
    """Whether the surfaces of two trees touch, at each of many poses.

    poses: where b is, (k, 7) or (k, 4, 4). poses_a: where a is, one or k of them; where it was built, if not given.
    A budget for each pose, in counted `work` (tests of spheres; the same answer everywhere) or `seconds`, may leave an
    answer at MAYBE, with bounds. order: "exact_first" is the fastest; "level_by_level" has the best bounds on the way.
    A body that lies wholly inside the other one does not touch it: see contains().

    >>> box = Tree.box([1, 1, 1])
    >>> collide(box, box, [[1.5, 0, 0, 1, 0, 0, 0], [2.5, 0, 0, 1, 0, 0, 0]]).touching
    array([ True, False])
    """
    limits = _limits(work, seconds)
    by_level = choice("order", order, ("exact_first", "level_by_level")) == "level_by_level"
    found = _runtime.collide(_of(tree_a, "tree_a"), _of(tree_b, "tree_b"),
                             _poses("poses_a", _IDENTITY if poses_a is None else poses_a), _poses("poses", poses),
                             _wxyz(quaternion), limits[0], limits[1], by_level)
    found = {name: view(array) for name, array in found.items()}
    return Collisions(triangles=_triangles(found.pop("triangles_a"), found.pop("triangles_b")), **found)


@dataclasses.dataclass(frozen=True, repr=False)
class Distances:
    """The distances at k poses: lower <= distance <= upper, certified."""

    lower: Floats  #: (k,), world units
    upper: Floats  #: (k,)
    points_a: Floats  #: (k, 3): of the surface of a, `upper` from the one of b
    points_b: Floats  #: (k, 3)
    triangles: Ints  #: (k, 2): that these are on

    def __len__(self) -> int:
        return len(self.lower)

    def __repr__(self) -> str:
        return f"<Distances at {len(self)} poses>"


def distance(tree_a: Tree, tree_b: Tree, poses: Anything, *, poses_a: Anything = None, quaternion: str = "wxyz",
             relative: float = 0.01, absolute: float = 0) -> Distances:
    """The distance between two surfaces at each pose, up to (1 + relative) lower + absolute; 0 if they touch. A solid
    wholly inside the other has a positive distance.

    >>> box = Tree.box([1, 1, 1])
    >>> float(distance(box, box, [3, 0, 0, 1, 0, 0, 0], relative=0).upper[0].round(6))
    1.0
    """
    found = _runtime.distance(_of(tree_a, "tree_a"), _of(tree_b, "tree_b"),
                              _poses("poses_a", _IDENTITY if poses_a is None else poses_a), _poses("poses", poses),
                              _wxyz(quaternion), number("relative", relative, 0, math.inf),
                              number("absolute", absolute, 0, math.inf))
    found = {name: view(array) for name, array in found.items()}
    return Distances(triangles=_triangles(found.pop("triangles_a"), found.pop("triangles_b")), **found)


def closer_than(tree_a: Tree, tree_b: Tree, poses: Anything, margin: float, *, poses_a: Anything = None,
                quaternion: str = "wxyz") -> Bytes:
    """Whether two surfaces are closer than `margin` (world units, at least 0) at each pose: (k,), each an Answer.

    >>> box = Tree.box([1, 1, 1])
    >>> closer_than(box, box, [3, 0, 0, 1, 0, 0, 0], 1.5)
    array([2], dtype=uint8)
    """
    return typing.cast(Bytes, view(_runtime.closer_than(
        _of(tree_a, "tree_a"), _of(tree_b, "tree_b"), _poses("poses_a", _IDENTITY if poses_a is None else poses_a),
        _poses("poses", poses), _wxyz(quaternion), number("margin", margin, 0, math.inf))))


@dataclasses.dataclass(frozen=True, repr=False)
class Contacts:
    """Where two bodies touch at k poses, and how they come apart."""

    answers: Bytes  #: (k,), each an Answer
    counts: numpy.typing.NDArray[numpy.uint32]  #: (k,): points, at most 4
    points: Floats  #: (k, 4, 3), world; only the first counts[i] count
    point_depths: Floats  #: (k, 4)
    normals: Floats  #: (k, 3), unit, from a to b
    depths: Floats  #: (k,): b moved so far along the normal is free; negative for a gap within the margin
    errors: Floats  #: (k,): of points and depth
    complete: Bools  #: (k,): whether shorter ways were looked for to the end

    def __len__(self) -> int:
        return len(self.answers)

    def __repr__(self) -> str:
        return f"<Contacts at {len(self)} poses: {int((self.counts > 0).sum())} with points>"


def contacts(tree_a: Tree, tree_b: Tree, poses: Anything, *, poses_a: Anything = None, quaternion: str = "wxyz",
             margin: float = 0, depth: bool = True, refinements: int = 12) -> Contacts:
    """Points, normal and depth of the contact at each pose. margin (world units): surfaces no farther apart have one
    point as well. depth=False leaves the depth out, at a fraction of the cost.

    >>> box = Tree.box([1, 1, 1])
    >>> float(contacts(box, box, [1.9, 0.1, 0, 1, 0, 0, 0]).depths[0].round(6))
    0.1
    """
    found = _runtime.contacts(_of(tree_a, "tree_a"), _of(tree_b, "tree_b"),
                              _poses("poses_a", _IDENTITY if poses_a is None else poses_a), _poses("poses", poses),
                              _wxyz(quaternion), number("margin", margin, 0, math.inf), bool(depth),
                              whole("refinements", refinements, 0, 1000))
    found = {name: view(array) for name, array in found.items()}
    return Contacts(complete=found.pop("complete").view(numpy.bool_), **found)


@dataclasses.dataclass(frozen=True, repr=False)
class Impacts:
    """When two moving bodies touch first, for k motions, in times from 0 (the first pose) to 1 (the last)."""

    answers: Bytes  #: (k,): NO: at no time; YES: not before t0, but at t1; MAYBE: not before t0, then very close
    t0: Floats  #: (k,): certified, no contact before
    t1: Floats  #: (k,): certified contact, or infinite
    distances: Floats  #: (k,): upper bound on the surfaces' distance at t0
    points_a: Floats  #: (k, 3): where, at t0
    points_b: Floats  #: (k, 3)

    def __len__(self) -> int:
        return len(self.answers)

    def __repr__(self) -> str:
        return f"<Impacts of {len(self)} motions>"


def time_of_impact(tree_a: Tree, tree_b: Tree, poses: Anything, poses_end: Anything, *, poses_a: Anything = None,
                   poses_a_end: Anything = None, quaternion: str = "wxyz", tolerance: float = 1e-4, margin: float = 0,
                   work: int | None = None) -> Impacts:
    """When two bodies touch first on the way from one pose to another: centres straight, rotations about one axis by
    the smallest angle. Certified, so that nothing tunnels. tolerance: how near is near enough, in world units.

    >>> box = Tree.box([1, 1, 1])
    >>> there, here = [4, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0, 0]
    >>> float(time_of_impact(box, box, there, here).t0[0].round(3))
    0.5
    """
    start_a = _poses("poses_a", _IDENTITY if poses_a is None else poses_a)
    end_a = start_a if poses_a_end is None else _poses("poses_a_end", poses_a_end)
    found = _runtime.time_of_impact(_of(tree_a, "tree_a"), _of(tree_b, "tree_b"), start_a, end_a,
                                    _poses("poses", poses), _poses("poses_end", poses_end), _wxyz(quaternion),
                                    number("tolerance", tolerance, 0, math.inf), number("margin", margin, 0, math.inf),
                                    _limits(work, None)[0])
    return Impacts(**{name: view(array) for name, array in found.items()})


@dataclasses.dataclass(frozen=True, repr=False)
class RayHits:
    """The first hits of k rays."""

    along: Floats  #: (k,): hit = origin + along * direction; infinite without one
    points: Floats  #: (k, 3), world; NaN without a hit
    triangles: Ints  #: (k,); -1 without a hit

    @property
    def hit(self) -> Bools:
        """(k,): whether each ray meets the surface."""
        return _flags(self.triangles >= 0)

    def __len__(self) -> int:
        return len(self.along)

    def __repr__(self) -> str:
        return f"<RayHits of {len(self)} rays: {int(self.hit.sum())} hits>"


def cast_rays(tree: Tree, origins: Anything, directions: Anything, *, longest: float = math.inf, pose: Anything = None,
              quaternion: str = "wxyz") -> RayHits:
    """The first triangle that each ray origin + t direction, 0 <= t <= longest, meets. Watertight. (k, 3) each.

    >>> float(cast_rays(Tree.box([1, 1, 1]), [[5, 0, 0]], [[-1, 0, 0]]).along[0])
    4.0
    """
    along = floats("directions", directions, 3, single=True)
    if not (along != 0).any(axis=1).all():
        raise ValueError("directions: one of them is 0")
    found = _runtime.cast_rays(_of(tree, "tree"), floats("origins", origins, 3, single=True), along,
                               number("longest", longest, 0, math.inf),
                               _poses("pose", _IDENTITY if pose is None else pose), _wxyz(quaternion))
    return RayHits(**{name: view(array) for name, array in found.items()})


@dataclasses.dataclass(frozen=True, repr=False)
class NearestPoints:
    """The points of a placed surface that are nearest to k points."""

    distances: Floats  #: (k,): negative inside the solid if the sign was asked for; infinite beyond the limit
    points: Floats  #: (k, 3), world
    triangles: Ints  #: (k,)
    normals: Floats | None = None  #: (k, 3), in which the distance grows; if the sign was asked for

    def __len__(self) -> int:
        return len(self.distances)

    def __repr__(self) -> str:
        return f"<NearestPoints of {len(self)} points>"


def nearest_points(tree: Tree, points: Anything, *, signed: bool = False, limit: float = math.inf,
                   pose: Anything = None, quaternion: str = "wxyz") -> NearestPoints:
    """The nearest points of a placed tree's surface, (k, 3). signed: distances are negative inside the solid.

    >>> float(nearest_points(Tree.box([1, 1, 1]), [[0.5, 0, 0]], signed=True).distances[0])
    -0.5
    """
    found = _runtime.nearest_points(_of(tree, "tree"), floats("points", points, 3, single=True),
                                    number("limit", limit, 0, math.inf),
                                    _poses("pose", _IDENTITY if pose is None else pose), _wxyz(quaternion),
                                    bool(signed))
    return NearestPoints(**{name: view(array) for name, array in found.items()})


def contains(tree: Tree, points: Anything, *, pose: Anything = None, quaternion: str = "wxyz") -> Bools:
    """Whether points lie inside the solid of a placed tree, (k,). Points of the surface may count either way.

    >>> contains(Tree.box([1, 1, 1]), [[0, 0, 0], [2, 0, 0]])
    array([ True, False])
    """
    return typing.cast(Bools, view(_runtime.contains(
        _of(tree, "tree"), floats("points", points, 3, single=True),
        _poses("pose", _IDENTITY if pose is None else pose), _wxyz(quaternion))).view(numpy.bool_))


from ._world import BroadPhase, Change, Detector, Event, Frame, WorldPoint  # noqa: E402
