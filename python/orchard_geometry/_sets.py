"""Sets of spheres without a tree, and what sets of any origin are beside a mesh."""
from __future__ import annotations

import dataclasses
import json
import math
import os
import typing

import numpy

from . import _construction
from ._arrays import Anything, Floats, choice, floats, number, view, whole
from ._mesh import Mesh
from ._progress import Progress
from ._trees import PathLike, _write


class Audit(typing.Dict[str, typing.Any]):
    """What a set of spheres is beside a mesh, by name: covered (proven), open_area and largest_gap (proven bounds),
    gap_place; of a solid protrusion (proven bounds), protruding, solid_volume, union_volume, outside_volume,
    uncovered_volume, mean_protrusion, mean_gap, two_sided_mean, of_union and of_solid (volume, center, inertia), and
    curobo's own figures. Lengths in mesh units."""

    def __repr__(self) -> str:
        low, high = self["open_area"]
        return (f"<Audit of {self['spheres']} spheres: {'covered' if self['covered'] else 'open'}, "
                f"open area {low:.4g} to {high:.4g} of {self['area']:.4g}>")


@dataclasses.dataclass(frozen=True, repr=False)
class SphereSet:
    """A set of spheres with a promise."""

    spheres: Floats  #: (n, 4): x y z r, the largest first
    fit: str  #: what is promised: cover, inside or balanced
    kept: bool  #: whether that is proven
    error_reached: bool  #: whether an error that was asked for is reached
    audit: Audit

    def __len__(self) -> int:
        return len(self.spheres)

    def __repr__(self) -> str:
        return f"<SphereSet: {len(self)} spheres, {self.fit}, {'kept' if self.kept else 'NOT kept'}>"

    def _repr_html_(self) -> str:
        rows = [("spheres", len(self)), ("fit", self.fit), ("promise kept", "yes" if self.kept else "no"),
                ("covered", "yes" if self.audit["covered"] else "no"),
                ("largest gap", f"{self.audit['largest_gap'][1]:.4g}")]
        return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"

    def save(self, file: PathLike) -> None:
        """Writes .txt (x y z r a line), .csv or .json (centers and radii)."""
        path = os.fspath(file)
        ending = os.path.splitext(path)[1].lower()
        rows = self.spheres.tolist()
        if ending == ".txt":
            text = "".join(" ".join(repr(x) for x in row) + "\n" for row in rows)
        elif ending == ".csv":
            text = "x,y,z,r\n" + "".join(",".join(repr(x) for x in row) + "\n" for row in rows)
        elif ending == ".json":
            text = json.dumps({"centers": [row[:3] for row in rows], "radii": [row[3] for row in rows]}) + "\n"
        else:
            raise ValueError(f"{path}: a set is saved as .txt, .csv or .json")
        _write(path, text.encode())

    def plot(self, *, axes: typing.Any = None) -> typing.Any:
        """Draws the spheres with matplotlib; returns the axes."""
        from ._plot import plot_spheres

        return plot_spheres(self.spheres, axes)

    def to_vtk(self) -> typing.Any:
        """A vtkPolyData of the centres with the array radius. Needs vtk."""
        from ._vtk import spheres_to_vtk

        return spheres_to_vtk(self.spheres)

    def to_pyvista(self) -> typing.Any:
        """The same for pyvista, where that is installed."""
        from ._vtk import wrap_pyvista

        return wrap_pyvista(self.to_vtk())

    def __reduce__(self) -> tuple[typing.Any, ...]:
        return SphereSet, (numpy.array(self.spheres), self.fit, self.kept, self.error_reached, self.audit)


def sphere_set(mesh: Anything, spheres: int = 20, *, fit: str = "cover", error: float = 0, volume_error: float = 0,
               solid: bool = False, padding: float = 0, min_radius: float = 0, effort: str = "default", seed: int = 1,
               strict: bool = False, progress: Progress = None) -> SphereSet:
    """Exactly so many spheres for a solid, with a promise: fit="cover" holds the whole surface (solid=True: the whole
    solid), proven; "inside" lies in the solid, proven; "balanced" has its volume within 1 %. With error or volume_error
    (percent of the diagonal, of the volume) as few as reach it, at most `spheres`. padding, of cover alone: every point
    so near to the surface is held, too. min_radius: no sphere is smaller. Both in mesh units.

    >>> from orchard_geometry import box_mesh
    >>> found = sphere_set(box_mesh(), 4, effort="low")
    >>> len(found), found.kept, found.audit["covered"]
    (4, True, True)
    """
    found = _construction.sphere_set(
        Mesh.of(mesh)._solid(bool(strict), progress), whole("spheres", spheres, 1, 2000),
        choice("fit", fit, ("cover", "inside", "balanced")), number("error", error, 0, 100) / 100,
        number("volume_error", volume_error, 0, 1e6) / 100, bool(solid), number("padding", padding, 0, math.inf),
        number("min_radius", min_radius, 0, math.inf), choice("effort", effort, ("low", "default", "high")),
        whole("seed", seed, 0, 2**64 - 1), progress)
    return SphereSet(view(found["spheres"]), fit, found["kept"], found["error_reached"], Audit(found["audit"]))


def audit(spheres: Anything, mesh: Anything, *, seed: int = 1, progress: Progress = None) -> Audit:
    """What a set of spheres of any origin, (n, 4) rows x y z r, a SphereSet or a level of a tree, leaves open beside a
    mesh, how far it sticks out, and its volume.

    >>> from orchard_geometry import box_mesh
    >>> audit([[0, 0, 0, 1.8]], box_mesh())["covered"]
    True
    """
    rows = spheres.spheres if isinstance(spheres, SphereSet) else floats("spheres", spheres, 4, single=True)
    if not len(rows):
        raise ValueError("spheres: there is none")
    surface = Mesh.of(mesh)
    done = surface.repair()
    return Audit(_construction.audit(done.mesh._surface if done.solid else surface._surface, rows,
                                     whole("seed", seed, 0, 2**64 - 1), progress))
