"""Spheres for the links of a robot, and the formats of planners and simulators."""
from __future__ import annotations

import dataclasses
import math
import os
import typing

import numpy

from . import _construction
from ._arrays import Floats, choice, number, view, whole
from ._progress import Progress
from ._sets import Audit
from ._trees import PathLike, _write


@dataclasses.dataclass(frozen=True, repr=False)
class LinkSpheres:
    """The spheres of one link, in its frame."""

    name: str
    spheres: Floats  #: (n, 4): x y z r in metres, the largest first, rounded as files have them
    kept: bool  #: whether the promise is proven of these numbers, in double and in float
    grown: float  #: metres: what all radii had to grow by for that
    audit: Audit
    notes: list[str]  #: what was repaired, wrapped or approximated, a sentence each

    def __len__(self) -> int:
        return len(self.spheres)

    def __repr__(self) -> str:
        return f"<LinkSpheres {self.name}: {len(self)}, {'kept' if self.kept else 'NOT kept'}>"


class RobotSpheres:
    """What robot() made."""

    def __init__(self, robot: _construction.Robot) -> None:
        self._robot = robot
        self.name: str = robot.name()
        self.notes: list[str] = robot.notes()  #: what the reader left out or had to decide, a sentence each
        self.links: dict[str, LinkSpheres] = {
            row["name"]: LinkSpheres(row["name"], view(row["spheres"]), row["kept"], row["grown"], Audit(row["audit"]),
                                     row["notes"]) for row in robot.links()}
        #: (link, link, verdict): Adjacent, Always, Never, ..: see docs/guide/robots.md; empty without states
        self.pairs: list[tuple[str, str, str]] = robot.pairs()

    def __len__(self) -> int:
        return sum(len(link) for link in self.links.values())

    def __repr__(self) -> str:
        return f"<RobotSpheres of {self.name}: {len(self)} spheres on {len(self.links)} links>"

    @property
    def kept(self) -> bool:
        """Whether the promise is proven for every link."""
        return all(link.kept for link in self.links.values())

    def poses(self, joints: typing.Mapping[str, float] | None = None) -> dict[str, Floats]:
        """Where each link is, (4, 4), from its frame to the root's. joints: values of free joints by name, radians or
        metres; the others are 0, or the nearest value that their limits allow."""
        return {name: numpy.array(rows) for name, rows in self._robot.poses(dict(joints or {}))}

    def spheres(self, joints: typing.Mapping[str, float] | None = None) -> Floats:
        """All spheres in the root's frame, (n, 4), link after link."""
        poses, rows = self.poses(joints), []
        for name, link in self.links.items():
            moved = numpy.array(link.spheres)
            moved[:, :3] = moved[:, :3] @ poses[name][:3, :3].T + poses[name][:3, 3]
            rows.append(moved)
        return numpy.concatenate(rows) if rows else numpy.zeros((0, 4))

    def save(self, folder: PathLike, format: str) -> list[str]:
        """Writes the files of a format (robot_formats() of the command line's --export) into a folder; returns them."""
        folder = os.fspath(folder)
        os.makedirs(folder, exist_ok=True)
        written = []
        names = _construction.robot_formats()
        for name, text in self._robot.files(choice("format", format, names), self.name):
            _write(os.path.join(folder, name), text.encode())
            written.append(os.path.join(folder, name))
        return written


def robot(urdf: PathLike, spheres: int = 60, *, fit: str = "cover", links: typing.Mapping[str, int] | None = None,
          fits: typing.Mapping[str, str] | None = None, packages: typing.Sequence[PathLike] = (),
          geometry: str = "collision", padding: float = 0, states: int = 10_000, effort: str = "default", seed: int = 1,
          progress: Progress = None) -> RobotSpheres:
    """Spheres for all links of a URDF, so many in all, shared among the links by what is loosest. fit: cover, inside or
    balanced. links and fits: a number of spheres, or another fit, for links by name. packages: folders in which
    package:// is looked for. geometry: collision or visual. padding of covers in metres. states: of the joints, drawn
    with `seed`, in which pairs of links are tested (0: no pairs). MeshError names file and line.
    """
    given = {"spheres": whole("spheres", spheres, 1, 100_000),
             "fit": choice("fit", fit, ("cover", "inside", "balanced")),
             "geometry": choice("geometry", geometry, ("collision", "visual")),
             "padding": number("padding", padding, 0, math.inf),
             "effort": choice("effort", effort, ("low", "default", "high")), "seed": whole("seed", seed, 0, 2**64 - 1)}
    numbers = {name: whole(f"links[{name}]", count, 1, 2000) for name, count in (links or {}).items()}
    other = {name: choice(f"fits[{name}]", one, ("cover", "inside", "balanced")) for name, one in (fits or {}).items()}
    return RobotSpheres(_construction.fit_robot(os.fspath(urdf), [os.fspath(one) for one in packages], given, numbers,
                                                other, whole("states", states, 0, 10_000_000), progress))
