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
    fit: str  #: what is promised: cover, inside, balanced or particles
    kept: bool  #: whether that is proven
    error_reached: bool  #: whether an error that was asked for is reached
    audit: Audit
    enough: int | None = None  #: where something is missed: a number of spheres that misses nothing, if one was found
    particles: dict[str, typing.Any] | None = None  #: of fit="particles": masses, body, errors, largest_overlap, filled

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
        return SphereSet, (numpy.array(self.spheres), self.fit, self.kept, self.error_reached, self.audit, self.enough,
                           self.particles)


@dataclasses.dataclass(frozen=True)
class Particles:
    """What fit="particles" shall keep: see `orchard spheres --help`."""

    overlap: float = 0  #: percent of the smaller of two spheres that may lie in the other
    equal: bool = False  #: all radii are equal
    density: float = 1  #: mass per cubic mesh unit
    density_of: str = "solid"  #: of the solid, whose mass the spheres share, or of each sphere ("balls")
    masses: bool = False  #: each sphere has a mass of its own
    center_error: float = 0.5  #: of the centre of mass, percent of the diagonal
    inertia_error: float = 2  #: of the inertia tensor at equal mass, percent

    def _checked(self) -> dict[str, typing.Any]:
        return {"overlap": number("overlap", self.overlap, 0, 100) / 100, "equal": bool(self.equal),
                "density": number("density", self.density, 1e-15, 1e15),
                "density_of": choice("density_of", self.density_of, ("solid", "balls")), "masses": bool(self.masses),
                "center_error": number("center_error", self.center_error, 1e-6, 100) / 100,
                "inertia_error": number("inertia_error", self.inertia_error, 1e-6, 1000) / 100}


def _weights(weights: Anything) -> tuple[Floats, Floats]:
    """Rows of balls (x y z r factor) and of boxes (two corners, factor)."""
    rows: dict[int, list[typing.Any]] = {5: [], 7: []}
    for row in weights:
        if len(row) not in rows:
            raise ValueError(f"weights: expected x y z r factor or x y z x y z factor, not {len(row)} numbers")
        if not (row[-1] > 0 and (len(row) == 7 or row[3] > 0)):
            raise ValueError("weights: radius and factor must be above 0")
        rows[len(row)].append(row)
    return floats("weights", rows[5], 5), floats("weights", rows[7], 7)


def sphere_set(mesh: Anything, spheres: int = 20, *, fit: str = "cover", error: float = 0, volume_error: float = 0,
               solid: bool = False, padding: float = 0, min_radius: float = 0, weights: Anything = (),
               vertex_weights: Anything = (), particles: Particles = Particles(), effort: str = "default",
               seed: int = 1, strict: bool = False, progress: Progress = None) -> SphereSet:
    """Exactly so many spheres for a solid, with a promise: fit="cover" holds the whole surface (solid=True: the whole
    solid), proven; "inside" lies in the solid, proven; "balanced" has its volume within 1 %; "particles" lie in it and
    keep to `particles`. With error or volume_error (percent of the diagonal, of the volume) as few as reach it, at most
    `spheres`. padding, of cover alone: every point so near to the surface is held, too. min_radius: no sphere is
    smaller. Both in mesh units. weights: rows (x, y, z, r, factor) of balls or (x, y, z, x, y, z, factor) of boxes in
    which looseness counts so many times; vertex_weights: (n,), the same near each vertex.

    >>> from orchard_geometry import box_mesh
    >>> found = sphere_set(box_mesh(), 4, effort="low")
    >>> len(found), found.kept, found.audit["covered"]
    (4, True, True)
    """
    surface = Mesh.of(mesh)._solid(bool(strict), progress)
    balls, boxes = _weights(weights)
    options = {"spheres": whole("spheres", spheres, 1, 2000),
               "fit": choice("fit", fit, ("cover", "inside", "balanced", "particles")),
               "error": number("error", error, 0, 100) / 100,
               "volume_error": number("volume_error", volume_error, 0, 1e6) / 100, "solid": bool(solid),
               "padding": number("padding", padding, 0, math.inf),
               "min_radius": number("min_radius", min_radius, 0, math.inf),
               "effort": choice("effort", effort, ("low", "default", "high")), "seed": whole("seed", seed, 0, 2**64 - 1)}
    found = _construction.sphere_set(surface, options, particles._checked(), balls, boxes,
                                     floats("vertex_weights", vertex_weights, 0), progress)
    return SphereSet(view(found["spheres"]), fit, found["kept"], found["error_reached"], Audit(found["audit"]),
                     found["enough"], found["particles"])


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
