"""Many bodies that move: the broad phase and the detector. orchard_geometry.runtime has them."""
from __future__ import annotations

import dataclasses
import enum
import math
import typing

import numpy

from . import _runtime
from ._arrays import Anything, Floats, Indices, floats, indices, number, view, whole
from ._poses import IDENTITY, Answer, limits_of, poses_of, tree_of, wxyz_of
from ._trees import Tree


def _vector(name: str, value: Anything) -> list[float]:
    array = floats(name, value, 0)
    if array.shape != (3,):
        raise ValueError(f"{name}: expected three numbers, not {array.shape}")
    return typing.cast("list[float]", array.tolist())


def _column(name: str, value: Anything, count: int, low: float = 0) -> Floats:
    """A number for all rows, or one for each; infinity is allowed."""
    array = numpy.asarray(value, dtype=numpy.float64)
    if array.ndim > 1 or (array.ndim == 1 and len(array) != count):
        raise ValueError(f"{name}: expected a number, or {count} of them")
    if numpy.isnan(array).any() or (array < low).any():
        raise ValueError(f"{name}: expected numbers that are not below {low:g}")
    return numpy.broadcast_to(array, (count,))


class BroadPhase:
    """Which bounding spheres of moving bodies overlap, and until when nothing can happen.

    Bodies fly straight on at the velocities that they have until update() says otherwise. Time passes in steps of
    time_step seconds; at each, the pairs reported are exactly those whose spheres touch.

    >>> world = BroadPhase(time_step=0.1)
    >>> world.add([[0, 0, 0], [5, 0, 0]], radii=1, velocities=[[1, 0, 0], [0, 0, 0]])
    array([0, 1], dtype=uint32)
    >>> time, pairs = world.advance(10)
    >>> round(time, 3), pairs.tolist()
    (3.0, [[0, 1]])
    """

    def __init__(self, time_step: float, *, start: float = 0) -> None:
        """time_step in seconds, above 0; start: the time of the first step."""
        self._world = _runtime.BroadPhase(number("time_step", time_step, 0, math.inf), number("start", start, -1e100, 1e100))

    def add(self, positions: Anything, *, radii: Anything, velocities: Anything = None, accelerations: Anything = 0,
            static: bool = False, category: int = 1, mask: int = 0xFFFFFFFF, group: int = 0) -> Indices:
        """Adds a body for each position, (n, 3), and returns their numbers, (n,). radii: of bounding spheres, one for
        all or (n,). velocities: (n, 3), 0 if not given. accelerations: bounds on how fast these may change."""
        rows = self._rows(positions, velocities, radii, accelerations)
        return typing.cast(Indices, view(self._world.add(
            rows, bool(static), whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1),
            whole("group", group, -2**31, 2**31 - 1))))

    def update(self, bodies: Anything, positions: Anything, *, radii: Anything, velocities: Anything = None,
               accelerations: Anything = 0, keeps_bounds: bool = False) -> None:
        """Sets where bodies are now, and how they move. keeps_bounds: the bodies have stayed within their earlier bounds,
        which saves time; overlaps are missed if they have not."""
        self._world.update(indices("bodies", bodies, 0), self._rows(positions, velocities, radii, accelerations),
                           bool(keeps_bounds))

    def remove(self, bodies: Anything) -> None:
        """Removes bodies by their numbers, (n,); a number may be used again."""
        self._world.remove(indices("bodies", bodies, 0))

    def advance(self, time: float) -> tuple[float, Indices]:
        """Goes to the first step with overlapping pairs that is not after `time`; returns its time and the pairs,
        (p, 2). Without pairs, the time before which nothing can happen."""
        found = self._world.advance(number("time", time, -1e100, 1e100))
        return float(found["time"]), view(found["pairs"])

    def cast_ray(self, origin: Anything, direction: Anything, *, longest: float = math.inf) -> tuple[int, float] | None:
        """The first body whose sphere a ray enters, and where along it."""
        return self._world.cast_ray(_vector("origin", origin), _vector("direction", direction),
                                    number("longest", longest, 0, math.inf))

    def touching_sphere(self, center: Anything, radius: float) -> Indices:
        """The bodies whose spheres a sphere touches, ascending."""
        return typing.cast(Indices, view(self._world.touching_sphere(_vector("center", center),
                                                                     number("radius", radius, 0, 1e100))))

    def touching_box(self, lower: Anything, upper: Anything) -> Indices:
        """The bodies whose spheres an upright box touches, ascending."""
        return typing.cast(Indices, view(self._world.touching_box(_vector("lower", lower), _vector("upper", upper))))

    def nearest(self, point: Anything, count: int = 1) -> list[tuple[int, float]]:
        """The bodies whose spheres are nearest to a point, with their distances, which are 0 inside."""
        return self._world.nearest(_vector("point", point), whole("count", count, 1, 2**31))

    @property
    def time(self) -> float:
        """Up to when everything has been reported."""
        return self._world.now()

    def __len__(self) -> int:
        return self._world.size()

    def __repr__(self) -> str:
        return f"<BroadPhase: {len(self)} bodies at {self.time:g} s>"

    @staticmethod
    def _rows(positions: Anything, velocities: Anything, radii: Anything, accelerations: Anything) -> Floats:
        places = floats("positions", positions, 3, single=True)
        count = len(places)
        rows = numpy.zeros((count, 10))
        rows[:, :3] = places
        if velocities is not None:
            flights = floats("velocities", velocities, 3, single=True)
            if len(flights) != count:
                raise ValueError(f"velocities: expected {count} of them, not {len(flights)}")
            rows[:, 3:6] = flights
        rows[:, 6] = _column("radii", radii, count)
        rows[:, 7] = _column("accelerations", accelerations, count)
        rows[:, 9] = math.inf
        return rows


class Change(enum.IntEnum):
    """What an event says of a pair."""

    BEGIN = 0  #: the first certain touch
    STAY = 1  #: touching since an earlier step
    END = 2  #: apart, certainly, after a begin
    POSSIBLE = 3  #: neither is certain: the budget ended


@dataclasses.dataclass(frozen=True)
class Event:
    """One pair of bodies at one step."""

    change: Change
    a: int  #: a body
    b: int  #: the other one
    time: float  #: of the step
    answer: Answer
    separation_bound: float  #: the solids are no farther apart
    point: tuple[float, float, float]  #: of the contact, world
    normal: tuple[float, float, float]  #: from a to b
    impact_time: float  #: of a contact between two steps, for continuous bodies; NaN otherwise
    index: int  #: for Detector.manifold()


@dataclasses.dataclass(frozen=True)
class Frame:
    """What Detector.step() found."""

    time: float  #: of the last step that was answered
    next_time: float  #: nothing begins or ends before
    steps: int  #: answered in this call
    steps_left: int  #: not 0 if there were too many events: call again with the same time
    pairs: int  #: of bodies whose spheres overlapped, over the steps
    certain: int  #: of these, with a certain answer
    work: int  #: as the budget counts it
    events: list[Event]


@dataclasses.dataclass(frozen=True)
class WorldPoint:
    """What a question about all bodies found."""

    body: int
    distance: float  #: along a ray in lengths of its direction
    point: tuple[float, float, float]


class Detector:
    """Which bodies touch, step by step, within a budget, always with bounds: broad phase, narrow phase and schedule.

    It keeps the states of bodies, which fly straight on until set_state() or set_velocity() says otherwise.

    >>> world = Detector(time_step=0.1)
    >>> box = world.add_box([1, 1, 1])
    >>> a, b = world.add_body(box), world.add_body(box, [5, 0, 0, 1, 0, 0, 0], velocity=[-1, 0, 0])
    >>> [(event.change.name, round(event.time, 3)) for event in world.step(3.05).events][:1]
    [('BEGIN', 3.0)]
    """

    def __init__(self, time_step: float = 0.01, *, start: float = 0, steps_to_end: int = 1) -> None:
        """time_step in seconds. steps_to_end: certain steps apart before an END; higher values debounce pairs that
        jitter at contact."""
        self._world = _runtime.Detector(number("time_step", time_step, 0, math.inf),
                                        number("start", start, -1e100, 1e100),
                                        whole("steps_to_end", steps_to_end, 1, 2**31))
        self._events: list[Event] = []

    def add_shape(self, tree: Tree) -> int:
        """A shape that any number of bodies may have: a tree."""
        return self._world.add_tree(tree_of(tree, "tree"))

    def add_sphere(self, radius: float, center: Anything = (0, 0, 0)) -> int:
        """A solid sphere as a shape."""
        return self._world.add_sphere(number("radius", radius, 0, 1e100), _vector("center", center))

    def add_capsule(self, p: Anything, q: Anything, radius: float) -> int:
        """The points within `radius` of the segment from p to q as a shape."""
        return self._world.add_capsule(_vector("p", p), _vector("q", q), number("radius", radius, 0, 1e100))

    def add_box(self, half_lengths: Anything) -> int:
        """A solid box around the origin as a shape; half the lengths of its edges."""
        return self._world.add_box(_vector("half_lengths", half_lengths))

    def add_body(self, shape: int, pose: Anything = IDENTITY, *, velocity: Anything = (0, 0, 0),
                 acceleration: float = 0, continuous_speed: float = 0, quaternion: str = "wxyz", category: int = 1,
                 mask: int = 0xFFFFFFFF, group: int = 0) -> int:
        """A body of a shape; returns its number. acceleration: a bound on how fast the velocity may change.
        continuous_speed above 0: contacts between two steps are found, too; no origin moves faster."""
        return self._world.add_body(whole("shape", shape, 0, 2**32 - 1), poses_of("pose", pose), wxyz_of(quaternion),
                                    _vector("velocity", velocity), number("acceleration", acceleration, 0, 1e100),
                                    number("continuous_speed", continuous_speed, 0, 1e100),
                                    whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1),
                                    whole("group", group, -2**31, 2**31 - 1))

    def add_static(self, shape: int, pose: Anything = IDENTITY, *, quaternion: str = "wxyz", category: int = 1,
                   mask: int = 0xFFFFFFFF, group: int = 0) -> int:
        """A body that never moves."""
        return self._world.add_static(whole("shape", shape, 0, 2**32 - 1), poses_of("pose", pose), wxyz_of(quaternion),
                                      whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1),
                                      whole("group", group, -2**31, 2**31 - 1))

    def add_half_space(self, normal: Anything, offset: float) -> int:
        """Everything with normal . point <= offset."""
        return self._world.add_half_space(_vector("normal", normal), number("offset", offset, -1e100, 1e100))

    def remove(self, body: int) -> None:
        """Removes a body."""
        self._world.remove(body)

    def set_state(self, body: int, pose: Anything, *, velocity: Anything = (0, 0, 0), acceleration: float = 0,
                  quaternion: str = "wxyz") -> None:
        """Where a body is at the time of the last step, and how it moves on."""
        self._world.set_state(body, poses_of("pose", pose), wxyz_of(quaternion), _vector("velocity", velocity),
                              number("acceleration", acceleration, 0, 1e100))

    def set_velocity(self, body: int, velocity: Anything) -> None:
        """How a body moves on from where it is."""
        self._world.set_velocity(body, _vector("velocity", velocity))

    def pose(self, body: int) -> Floats:
        """Where a body is at the time of the last step: a 4 x 4 matrix."""
        state = self._world.state(body)
        matrix = numpy.eye(4)
        matrix[:3, :3] = numpy.asarray(state["rotation"]).reshape(3, 3)
        matrix[:3, 3] = state["translation"]
        return matrix

    def velocity(self, body: int) -> Floats:
        """The velocity of a body, (3,)."""
        return numpy.asarray(self._world.state(body)["velocity"])

    def step(self, time: float, *, work: int | None = None, seconds: float | None = None) -> Frame:
        """Answers the steps up to `time`, within a budget of counted work or seconds."""
        limits = limits_of(work, seconds)
        found = self._world.step(number("time", time, -1e100, 1e100), limits[0], limits[1])
        names = ("changes", "a", "b", "times", "answers", "separation_bounds", "points", "normals", "impact_times")
        rows = zip(*(view(found[name]).tolist() for name in names))
        events = [Event(Change(change), a, b, when, Answer(answer), bound, _triple(point), _triple(normal), impact, index)
                  for index, (change, a, b, when, answer, bound, point, normal, impact) in enumerate(rows)]
        self._events = events
        return Frame(events=events, **{name: found[name] for name in (
            "time", "next_time", "steps", "steps_left", "pairs", "certain", "work")})

    def manifold(self, event: Event) -> dict[str, typing.Any]:
        """Where an event of the last step touches, and how its bodies come apart: answer, points (n, 3), point_depths,
        normal from a to b, depth."""
        if not (event.index < len(self._events) and self._events[event.index] is event):
            raise ValueError("event: it is none of the last step")
        found = self._world.manifold(event.index)
        return {"answer": Answer(found["answer"]), "points": view(found["points"]),
                "point_depths": view(found["point_depths"]), "normal": numpy.asarray(found["normal"]),
                "depth": found["depth"]}

    def cast_ray(self, origin: Anything, direction: Anything, *, longest: float = math.inf) -> WorldPoint | None:
        """The first point of any body that a ray meets, as of the last step."""
        return _point(self._world.cast_ray(_vector("origin", origin), _vector("direction", direction),
                                           number("longest", longest, 0, math.inf)))

    def nearest(self, point: Anything, *, limit: float = math.inf) -> WorldPoint | None:
        """The point of any body that is nearest, if it is no farther than the limit."""
        return _point(self._world.nearest(_vector("point", point), number("limit", limit, 0, math.inf)))

    def touching_sphere(self, center: Anything, radius: float) -> list[int]:
        """The bodies that a solid sphere touches."""
        return self._world.touching_sphere(_vector("center", center), number("radius", radius, 0, 1e100))

    @property
    def time(self) -> float:
        """Of the last call of step()."""
        return self._world.now()

    def __len__(self) -> int:
        return self._world.size()

    def __repr__(self) -> str:
        return f"<Detector: {len(self)} bodies at {self.time:g} s>"


def _triple(numbers: list[float]) -> tuple[float, float, float]:
    x, y, z = numbers
    return x, y, z


def _point(found: dict[str, typing.Any] | None) -> WorldPoint | None:
    if found is None:
        return None
    return WorldPoint(found["body"], found["distance"], _triple(found["point"]))
