"""Sphere-trees and collision answers: orchard's run-time. It is under the MIT licence and needs nothing else of orchard.

Trees come from `orchard build`, from orchard_geometry.sphere_tree(), or from a few simple shapes. All questions take
many poses at once, run without the GIL, and only read the trees, which any number of threads may share.

A pose is a row of 7 numbers, tx ty tz qw qx qy qz as on the command line (quaternion="xyzw": tx ty tz qx qy qz qw), or
a 4 x 4 matrix with the translation in its last column. Quaternions have length 1; others are refused.
"""
from __future__ import annotations

from . import _runtime
from ._pairs import (Collisions, Contacts, Distances, Impacts, closer_than, collide, contacts, distance,
                     time_of_impact)
from ._poses import Answer
from ._shapes import NearestPoints, RayHits, cast_rays, contains, nearest_points
from ._trees import Tree, load
from ._world import BroadPhase, Change, Detector, Event, Frame, WorldPoint

__all__ = ["Answer", "BroadPhase", "Change", "Collisions", "Contacts", "Detector", "Distances", "Event", "Frame",
           "Impacts", "NearestPoints", "RayHits", "Tree", "WorldPoint", "cast_rays", "closer_than", "collide",
           "contacts", "contains", "distance", "load", "nearest_points", "time_of_impact"]
__version__: str = _runtime.version
