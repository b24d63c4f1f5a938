"""orchard from Python: triangle mesh -> medial axis -> certified sphere-tree -> collision answers.

    import orchard_geometry as og
    axis = og.medial_axis("lamp.obj")
    tree = og.sphere_tree("lamp.obj")
    og.collide(tree, tree, [[3.2, 0, 0, 1, 0, 0, 0]]).touching

Construction, from meshes to trees, is under the GPL; orchard_geometry.runtime, collision answers, is under the MIT
licence, and works where the rest is not installed. Names of the rest are imported when they are first used.
Arrays are NumPy's, lengths in mesh units, and distances negative inside.
"""
from __future__ import annotations

import importlib
import importlib.util
import typing

from . import runtime
from ._errors import Cancelled, MeshError, OrchardError, RepairWarning
from .runtime import (Answer, BroadPhase, Detector, Tree, cast_rays, closer_than, collide, contacts, distance,
                      nearest_points, time_of_impact)

if typing.TYPE_CHECKING:
    from ._applications import Curve, Offset, Skeleton, SurfaceParts, hollow, offset
    from ._medial import (MedialAxis, Quality, StructureGraph, Structure, box_mesh, medial_axis, tuning_options)
    from ._mesh import (Mesh, closest_points, contains, inspect, load, repair, sample_surface, set_threads,
                        signed_distance, wrap)
    from ._sets import Audit, Particles, SphereSet, audit, sphere_set
    from ._robot import LinkSpheres, RobotSpheres, robot
    from ._spheretree import Certificate, SphereTree, sphere_tree
    from ._thickness import LocalThickness, Thickness, local_thickness, thickness
    from ._voronoi import Voronoi, voronoi

__version__: str = runtime.__version__

_CONSTRUCTION = {
    "_mesh": ("Mesh", "closest_points", "contains", "inspect", "load", "repair", "sample_surface", "set_threads",
              "signed_distance", "wrap"),
    "_voronoi": ("Voronoi", "voronoi"),
    "_medial": ("MedialAxis", "Quality", "StructureGraph", "Structure", "box_mesh", "medial_axis", "tuning_options"),
    "_applications": ("Curve", "Offset", "Skeleton", "SurfaceParts", "hollow", "offset"),
    "_thickness": ("LocalThickness", "Thickness", "local_thickness", "thickness"),
    "_spheretree": ("Certificate", "SphereTree", "sphere_tree"),
    "_robot": ("LinkSpheres", "RobotSpheres", "robot"),
    "_sets": ("Audit", "Particles", "SphereSet", "audit", "sphere_set"),
}
_HOME = {name: module for module, names in _CONSTRUCTION.items() for name in names}

__all__ = [
    "Answer", "Audit", "BroadPhase", "Cancelled", "Certificate", "Curve", "Detector", "LinkSpheres", "LocalThickness",
    "MedialAxis", "Mesh", "MeshError", "Offset", "OrchardError", "Particles", "Quality", "RepairWarning", "RobotSpheres",
    "Skeleton", "StructureGraph", "SphereSet", "SphereTree", "Structure", "SurfaceParts", "Thickness", "Tree", "Voronoi", "audit", "box_mesh",
    "cast_rays", "closer_than", "closest_points", "collide", "contacts", "contains", "distance", "hollow", "inspect", "load",
    "local_thickness", "medial_axis", "nearest_points", "offset", "repair", "robot", "runtime", "sample_surface",
    "set_threads", "signed_distance", "sphere_set", "sphere_tree", "thickness", "time_of_impact", "tuning_options",
    "voronoi", "wrap",
]


def __getattr__(name: str) -> typing.Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if importlib.util.find_spec(__name__ + "._construction") is None:
        raise ImportError(f"{name} belongs to the construction, which is not installed here; there is the run-time "
                          "alone")
    module = importlib.import_module("." + _HOME[name], __name__)
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(__all__))
