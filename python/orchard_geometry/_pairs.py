"""Questions about pairs of trees. orchard_geometry.runtime has them."""
from __future__ import annotations

import dataclasses
import math
import typing

import numpy
import numpy.typing

from . import _runtime
from ._arrays import Anything, Floats, choice, number, view, whole
from ._poses import IDENTITY, Answer, flags, limits_of, poses_of, triangles_of, wxyz_of, tree_of
from ._trees import Bools, Bytes, Ints, Tree


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
        return flags(self.answers == Answer.YES)

    @property
    def apart(self) -> Bools:
        """(k,): whether the surfaces do not touch, which is certain."""
        return flags(self.answers == Answer.NO)

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
    limits = limits_of(work, seconds)
    by_level = choice("order", order, ("exact_first", "level_by_level")) == "level_by_level"
    found = _runtime.collide(tree_of(tree_a, "tree_a"), tree_of(tree_b, "tree_b"),
                             poses_of("poses_a", IDENTITY if poses_a is None else poses_a), poses_of("poses", poses),
                             wxyz_of(quaternion), limits[0], limits[1], by_level)
    found = {name: view(array) for name, array in found.items()}
    return Collisions(triangles=triangles_of(found.pop("triangles_a"), found.pop("triangles_b")), **found)


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
    found = _runtime.distance(tree_of(tree_a, "tree_a"), tree_of(tree_b, "tree_b"),
                              poses_of("poses_a", IDENTITY if poses_a is None else poses_a), poses_of("poses", poses),
                              wxyz_of(quaternion), number("relative", relative, 0, math.inf),
                              number("absolute", absolute, 0, math.inf))
    found = {name: view(array) for name, array in found.items()}
    return Distances(triangles=triangles_of(found.pop("triangles_a"), found.pop("triangles_b")), **found)


def closer_than(tree_a: Tree, tree_b: Tree, poses: Anything, margin: float, *, poses_a: Anything = None,
                quaternion: str = "wxyz") -> Bytes:
    """Whether two surfaces are closer than `margin` (world units, at least 0) at each pose: (k,), each an Answer.

    >>> box = Tree.box([1, 1, 1])
    >>> closer_than(box, box, [3, 0, 0, 1, 0, 0, 0], 1.5)
    array([2], dtype=uint8)
    """
    return typing.cast(Bytes, view(_runtime.closer_than(
        tree_of(tree_a, "tree_a"), tree_of(tree_b, "tree_b"), poses_of("poses_a", IDENTITY if poses_a is None else poses_a),
        poses_of("poses", poses), wxyz_of(quaternion), number("margin", margin, 0, math.inf))))


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
    found = _runtime.contacts(tree_of(tree_a, "tree_a"), tree_of(tree_b, "tree_b"),
                              poses_of("poses_a", IDENTITY if poses_a is None else poses_a), poses_of("poses", poses),
                              wxyz_of(quaternion), number("margin", margin, 0, math.inf), bool(depth),
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
    start_a = poses_of("poses_a", IDENTITY if poses_a is None else poses_a)
    end_a = start_a if poses_a_end is None else poses_of("poses_a_end", poses_a_end)
    found = _runtime.time_of_impact(tree_of(tree_a, "tree_a"), tree_of(tree_b, "tree_b"), start_a, end_a,
                                    poses_of("poses", poses), poses_of("poses_end", poses_end), wxyz_of(quaternion),
                                    number("tolerance", tolerance, 0, math.inf), number("margin", margin, 0, math.inf),
                                    limits_of(work, None)[0])
    return Impacts(**{name: view(array) for name, array in found.items()})
