"""Trees as the run-time has them. orchard_geometry.runtime has the class."""
from __future__ import annotations

import os
import typing

import numpy
import numpy.typing

from . import _runtime
from ._arrays import Anything, Floats, floats, indices, view

Ints = numpy.typing.NDArray[numpy.int64]
Bytes = numpy.typing.NDArray[numpy.uint8]
Bools = numpy.typing.NDArray[numpy.bool_]
PathLike = typing.Union[str, "os.PathLike[str]"]


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
