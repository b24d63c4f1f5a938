"""Certified sphere-trees."""
from __future__ import annotations

import dataclasses
import math
import os
import typing

from . import _construction, _runtime
from ._arrays import Anything, choice, floats, number, whole
from ._medial import MedialAxis
from ._mesh import Mesh
from ._progress import Progress
from ._tuning import keyword, tuning_of
from ._trees import PathLike, Tree, _write

_METHODS = ("tightened", "merging", "annealing", "octree")


@dataclasses.dataclass(frozen=True, repr=False)
class Certificate:
    """What verifying a tree proved: that every point of the surface lies in all spheres of a path from the root to a
    leaf, that every stored bound holds, and that leaves list the triangles that they cover."""

    ok: bool
    same_mesh: bool  #: the tree's triangles are the mesh's
    triangles: int
    triangles_uncovered: int
    triangles_unlisted: int
    nodes: int
    bounds_violated: int
    violations: list[dict[str, typing.Any]]  #: kind, node, triangle, point, amount; 100 at most

    def __bool__(self) -> bool:
        return self.ok

    def __repr__(self) -> str:
        if self.ok:
            return f"<Certificate: {self.triangles} triangles and {self.nodes} spheres, all proven>"
        return (f"<Certificate: NOT proven: {self.triangles_uncovered} triangles uncovered, "
                f"{self.bounds_violated} bounds violated>")


class SphereTree(Tree):
    """A certified sphere-tree, and what building it said. For the run-time it is a Tree like any other."""

    _sph: str | None = None
    #: What was proven of the packed floats; None of a tree that was loaded: see verify().
    certificate: Certificate | None = None
    #: Of each level: spheres, and mean and max inaccuracy over the bounding radius.
    level_figures: list[dict[str, typing.Any]]
    #: points and seconds of each stage.
    report: dict[str, typing.Any]

    def __init__(self, tree: _runtime.Tree) -> None:
        super().__init__(tree)
        self.level_figures, self.report = [], {}

    @classmethod
    def load(cls, file: PathLike, mesh: Anything = None) -> SphereTree:
        """The tree of an .orchard file, or of an .sph file of any system together with the mesh that it is of, whose
        bounds are then measured and which is certified if it can be."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() != ".sph":
            return cls(_runtime.Tree.load(path))
        if mesh is None:
            raise ValueError(f"{path}: an .sph file has spheres alone; give the mesh that it is of")
        return cls._built(_construction.read_sph(Mesh.of(mesh)._solid(False, None), path))

    @classmethod
    def _built(cls, found: dict[str, typing.Any]) -> SphereTree:
        tree = cls(_runtime.Tree.from_bytes(found["bytes"]))
        tree._sph = found["sph"]
        tree.certificate = Certificate(**found["certificate"])
        tree.level_figures = found.get("levels", [])
        tree.report = {name: found[name] for name in ("points", "seconds") if name in found}
        return tree

    def verify(self, mesh: Anything, *, progress: Progress = None) -> Certificate:
        """Proves cover and bounds from the tree's floats and the mesh alone. The mesh is repaired as for building."""
        surface = Mesh.of(mesh)._solid(False, progress)
        return Certificate(**_construction.verify(surface, self.to_bytes(), progress))

    def save(self, file: PathLike) -> None:
        """Writes .orchard, for the run-time, or .sph, the spheres as text: the same bytes as the command."""
        path = os.fspath(file)
        if os.path.splitext(path)[1].lower() == ".sph":
            text = self._sph
            if text is None:
                text = _construction.to_sph(self.to_bytes())
            _write(path, text.encode())
        else:
            super().save(path)

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return _unpickled, (self.to_bytes(), self._sph, self.certificate, self.level_figures, self.report)


def _unpickled(data: bytes, sph: str | None, certificate: Certificate | None, level_figures: list[dict[str, typing.Any]],
               report: dict[str, typing.Any]) -> SphereTree:
    tree = SphereTree(_runtime.Tree.from_bytes(data))
    tree._sph, tree.certificate, tree.level_figures, tree.report = sph, certificate, level_figures, report
    return tree


def _tree_options(options: dict[str, typing.Any]) -> dict[str, typing.Any]:
    """Those that are given, in range."""
    ranges: dict[str, tuple[int, int]] = {
        "depth": (1, 20), "branching": (2, 1024), "descent": (0, 100_000), "anneal_first_trials": (1, 1_000_000),
        "anneal_max_accepted": (1, 1_000_000), "anneal_max_rejected": (1, 1_000_000),
        "anneal_max_uncovering": (1, 1_000_000), "anneal_first_iterations": (1, 1_000_000),
        "anneal_iterations": (1, 1_000_000)}
    reals: dict[str, tuple[float, float]] = {
        "error": (0, math.inf), "anneal_move": (0, 1), "anneal_min_scale": (0.01, 1), "anneal_max_scale": (1, 100),
        "anneal_first_acceptance": (1e-6, 1 - 1e-6), "anneal_cooling": (1e-6, 1 - 1e-6)}
    given: dict[str, typing.Any] = {}
    for name, value in options.items():
        if value is None:
            continue
        if name in ranges:
            value = whole(name, value, *ranges[name])
        elif name in reals:
            value = number(name, value, *reals[name])
        elif name == "anneal":
            value = bool(value)
        elif name == "spheres":
            value = [whole("spheres", count, 2, 2**31 - 1) for count in value]
        elif name == "regions":
            rows = floats("regions", value, 5, single=True)
            if not (rows[:, 3:] > 0).all():
                raise ValueError("regions: the radius and the error of each must be above 0")
            value = [tuple(row) for row in rows.tolist()]
        given[name] = value
    return given


def _refuse_idle(method: str, options: dict[str, typing.Any], tuning: dict[str, str]) -> None:
    """As the command does: an option that would have no effect is refused by name."""
    of_method = {"spheres": "tightened", "objective": "tightened", "closing": "merging", "energy": "annealing"}
    anneals = options.get("anneal", False)
    if anneals and method == "annealing":
        raise ValueError("anneal has no effect with method='annealing', which anneals anyway")
    for name in options:
        owner = "annealing" if name.startswith("anneal_") else of_method.get(name, method)
        if owner != method and not (anneals and owner == "annealing"):
            raise ValueError(f"{name} has no effect with method={method!r}")
    if "effort" in options and not anneals and method in ("merging", "octree"):
        raise ValueError(f"effort has no effect with method={method!r}")
    if "spheres" in options and ("depth" in options or "branching" in options):
        raise ValueError("spheres excludes depth and branching")
    sampling = {"samples", "edge-samples", "relaxation", "iterations", "cluster-angle", "crease-angle", "seed"}
    if method in ("octree", "annealing"):
        sampling = {"seed"}
    for name in tuning:
        if method != "merging" and name not in sampling:
            raise ValueError(f"{name.replace('-', '_')} has no effect with method={method!r}")


def sphere_tree(
    mesh: Anything,
    *,
    method: str = "tightened",
    depth: int | None = None,
    branching: int | None = None,
    spheres: typing.Sequence[int] | None = None,
    effort: str | None = None,
    objective: str | None = None,
    closing: str | None = None,
    energy: str | None = None,
    redundant: str | None = None,
    descent: int | None = None,
    anneal: bool | None = None,
    error: float | None = None,
    regions: Anything = None,
    seconds: float | None = None,
    anneal_distance: str | None = None,
    anneal_move: float | None = None,
    anneal_min_scale: float | None = None,
    anneal_max_scale: float | None = None,
    anneal_first_trials: int | None = None,
    anneal_first_acceptance: float | None = None,
    anneal_max_accepted: int | None = None,
    anneal_max_rejected: int | None = None,
    anneal_max_uncovering: int | None = None,
    anneal_cooling: float | None = None,
    anneal_first_iterations: int | None = None,
    anneal_iterations: int | None = None,
    axis: MedialAxis | None = None,
    points: Anything = None,
    strict: bool = False,
    progress: Progress = None,
    **tuning: typing.Any,
) -> SphereTree:
    """A certified sphere-tree of a solid: every point of the surface lies in all spheres of a path from the root to a
    leaf, proven for the floats that ship.

    Options are those of `orchard build`. method: "tightened", the tightest; "merging" along the medial axis;
    "annealing"; "octree". depth (3): levels below the root. branching (8): children of a sphere. spheres: how many each
    level may have, in place of both. effort: "low", "default", "high". objective: what to keep low, "balanced",
    "maximum", "mean" or "volume". error: no children for a sphere whose inaccuracy is this or less, in mesh units;
    regions: rows x y z r error, the same within balls. anneal: simulated annealing afterwards, after any other method. seconds: the tightest tree after so long, at whatever effort.
    axis: start from this medial axis (merging). points: start from your own surface points, (n, 3). Tuning options of
    medial_axis() are keywords, too: samples and seed of all, others of merging.

    The same bytes as the command with the same options, whatever the number of threads.

    >>> from orchard_geometry import box_mesh
    >>> tree = sphere_tree(box_mesh(), depth=1, effort="low")
    >>> bool(tree.certificate), tree.spheres(1).shape[1]
    (True, 4)
    """
    choice("method", method, _METHODS)
    known = _tuning_names()
    for name in tuning:
        if name not in known:
            raise TypeError(f"sphere_tree() has no option {name!r}")
    options = _tree_options({
        "depth": depth, "branching": branching, "spheres": spheres, "effort": effort, "objective": objective,
        "closing": closing, "energy": energy, "redundant": redundant, "descent": descent, "anneal": anneal, "error": error,
        "regions": regions, "anneal_distance": anneal_distance, "anneal_move": anneal_move,
        "anneal_min_scale": anneal_min_scale, "anneal_max_scale": anneal_max_scale,
        "anneal_first_trials": anneal_first_trials, "anneal_first_acceptance": anneal_first_acceptance,
        "anneal_max_accepted": anneal_max_accepted, "anneal_max_rejected": anneal_max_rejected,
        "anneal_max_uncovering": anneal_max_uncovering, "anneal_cooling": anneal_cooling,
        "anneal_first_iterations": anneal_first_iterations, "anneal_iterations": anneal_iterations})
    given = tuning_of(**tuning)
    _refuse_idle(method, options, given)
    if seconds is not None and (method != "tightened" or effort is not None):
        raise ValueError("seconds is for method='tightened', and in place of effort")
    if axis is not None and (method != "merging" or points is not None):
        raise ValueError("axis is for method='merging', and in place of points")
    if points is not None and method in ("octree", "annealing"):
        raise ValueError(f"points has no effect with method={method!r}")
    options["method"] = method
    surface = Mesh.of(mesh)._solid(bool(strict), progress)
    found = _construction.sphere_tree(
        surface, options, given, None if points is None else floats("points", points, 3),
        None if axis is None else axis._axis, None if seconds is None else number("seconds", seconds, 0, 1e6), progress)
    return SphereTree._built(found)


def _tuning_names() -> set[str]:
    """Those that `orchard build` has: what leads to an axis that is not refined."""
    refining = 4  # TuningStep::refining of apps/medial/medial_tuning.h
    return {keyword(row["name"]) for row in _construction.tuning_table() if row["step"] < refining}
