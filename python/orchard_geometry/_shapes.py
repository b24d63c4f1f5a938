"""Questions about points and rays beside one tree. orchard_geometry.runtime has them."""
from __future__ import annotations

import dataclasses
import math
import typing

import numpy

from . import _runtime
from ._arrays import Anything, Floats, floats, number, view
from ._poses import IDENTITY, flags, poses_of, wxyz_of, tree_of
from ._trees import Bools, Ints, Tree


@dataclasses.dataclass(frozen=True, repr=False)
class RayHits:
    """The first hits of k rays."""

    along: Floats  #: (k,): hit = origin + along * direction; infinite without one
    points: Floats  #: (k, 3), world; NaN without a hit
    triangles: Ints  #: (k,); -1 without a hit

    @property
    def hit(self) -> Bools:
        """(k,): whether each ray meets the surface."""
        return flags(self.triangles >= 0)

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
    found = _runtime.cast_rays(tree_of(tree, "tree"), floats("origins", origins, 3, single=True), along,
                               number("longest", longest, 0, math.inf),
                               poses_of("pose", IDENTITY if pose is None else pose), wxyz_of(quaternion))
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
    found = _runtime.nearest_points(tree_of(tree, "tree"), floats("points", points, 3, single=True),
                                    number("limit", limit, 0, math.inf),
                                    poses_of("pose", IDENTITY if pose is None else pose), wxyz_of(quaternion),
                                    bool(signed))
    return NearestPoints(**{name: view(array) for name, array in found.items()})


def contains(tree: Tree, points: Anything, *, pose: Anything = None, quaternion: str = "wxyz") -> Bools:
    """Whether points lie inside the solid of a placed tree, (k,). Points of the surface may count either way.

    >>> contains(Tree.box([1, 1, 1]), [[0, 0, 0], [2, 0, 0]])
    array([ True, False])
    """
    return typing.cast(Bools, view(_runtime.contains(
        tree_of(tree, "tree"), floats("points", points, 3, single=True),
        poses_of("pose", IDENTITY if pose is None else pose), wxyz_of(quaternion))).view(numpy.bool_))
