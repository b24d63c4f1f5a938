"""Meshes of other libraries, by what they have and not by their types: none of them is imported."""
from __future__ import annotations

import typing

import numpy

from ._arrays import Anything

Arrays = typing.Tuple[Anything, Anything]


def arrays_of(thing: Anything) -> Arrays:
    """Vertices and triangles of what has .vertices and .faces (trimesh) or .triangles (Open3D), .points and .cells
    (meshio) or .faces (pyvista), of a vtkPolyData, or of a pair of arrays. TypeError for anything else."""
    if hasattr(thing, "GetPolys"):
        from ._vtk import arrays_of_vtk

        return arrays_of_vtk(thing)
    if hasattr(thing, "vertices"):
        for name in ("faces", "triangles"):
            if hasattr(thing, name):
                return thing.vertices, getattr(thing, name)
    if hasattr(thing, "points"):
        if hasattr(thing, "faces"):
            return thing.points, triangles_of_runs(thing.faces)
        if hasattr(thing, "cells"):
            return thing.points, triangles_of_blocks(thing.cells)
    if isinstance(thing, (tuple, list)) and len(thing) == 2:
        return thing[0], thing[1]
    raise TypeError(f"expected a Mesh, a file, or an object with .vertices and .faces or .points and .cells, not "
                    f"{type(thing).__name__}")


def triangles_of_polygons(polygons: Anything) -> Anything:
    """(m, k) convex polygons as fans of triangles, (m (k - 2), 3)."""
    corners = numpy.asarray(polygons)
    fans = [numpy.stack([corners[:, 0], corners[:, i], corners[:, i + 1]], axis=1)
            for i in range(1, corners.shape[1] - 1)]
    return numpy.stack(fans, axis=1).reshape(-1, 3)


def triangles_of_blocks(cells: Anything) -> Anything:
    """Of meshio: blocks of a type and its cells, or a dictionary of them."""
    blocks = cells.items() if isinstance(cells, dict) else [
        (block.type, block.data) if hasattr(block, "type") else (block[0], block[1]) for block in cells]
    found = []
    for kind, data in blocks:
        if kind in ("triangle", "quad", "polygon"):
            found.append(triangles_of_polygons(data))
        elif kind not in ("vertex", "line"):
            raise ValueError(f"cells of the type {kind} are no part of a surface; take the surface of the mesh first")
    if not found:
        raise ValueError("the mesh has no triangles")
    return numpy.concatenate(found)


def triangles_of_runs(faces: Anything) -> Anything:
    """Of pyvista: each face as its number of corners and then these, all in one array. An (m, 3) array is as it is."""
    flat = numpy.asarray(faces)
    if flat.ndim == 2:
        return flat
    if flat.size and flat.size % (flat[0] + 1) == 0 and (flat[:: flat[0] + 1] == flat[0]).all():
        return triangles_of_polygons(flat.reshape(-1, flat[0] + 1)[:, 1:])
    found, at = [], 0
    while at < flat.size:
        count = int(flat[at])
        if count < 0 or at + count >= flat.size:
            raise ValueError("faces: not runs of a number of corners and these")
        if count > 2:
            found.append(triangles_of_polygons(flat[numpy.newaxis, at + 1:at + 1 + count]))
        at += count + 1
    return numpy.concatenate(found) if found else numpy.zeros((0, 3), numpy.int64)
