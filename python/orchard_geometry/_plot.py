"""Pictures by matplotlib, which is imported when one is drawn."""
from __future__ import annotations

import typing

import numpy

from ._arrays import Floats

if typing.TYPE_CHECKING:
    from ._medial import MedialAxis

_EDGES_AT_MOST = 20_000  # drawn one by one, so that a large axis is drawn in seconds


def _axes(axes: typing.Any) -> typing.Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as pyplot

    return pyplot.figure(figsize=(6, 6)).add_subplot(projection="3d")


def _fit(axes: typing.Any, points: Floats) -> None:
    """The same scale along all three axes."""
    if len(points):
        lower, upper = points.min(axis=0), points.max(axis=0)
        middle, half = (lower + upper) / 2, max(float((upper - lower).max()) / 2, 1e-30)
        axes.set_xlim(middle[0] - half, middle[0] + half)
        axes.set_ylim(middle[1] - half, middle[1] + half)
        axes.set_zlim(middle[2] - half, middle[2] + half)
        axes.set_box_aspect((1, 1, 1), zoom=1.2)


def plot_mesh(vertices: Floats, faces: typing.Any, values: typing.Any, axes: typing.Any, **style: typing.Any) -> typing.Any:
    """Triangles, coloured by a value for each; NaN is grey."""
    from matplotlib import colormaps
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    axes = _axes(axes)
    corners = vertices[faces]
    if values is None:
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = numpy.linalg.norm(normals, axis=1, keepdims=True)
        light = numpy.abs((normals / numpy.where(lengths > 0, lengths, 1)) @ numpy.array([0.35, -0.6, 0.72]))
        colors = numpy.repeat((0.45 + 0.5 * light)[:, numpy.newaxis], 4, axis=1)
        colors[:, 3] = 1
        axes.add_collection3d(Poly3DCollection(corners, facecolors=colors, **style))
    else:
        shown = numpy.asarray(values, dtype=float)
        if shown.shape != (len(faces),):
            raise ValueError(f"values: expected {len(faces)} of them, one for each face, not {shown.shape}")
        known = shown[numpy.isfinite(shown)]
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
        colors = colormaps["viridis"]((shown - low) / (high - low if high > low else 1))
        colors[~numpy.isfinite(shown)] = (0.7, 0.7, 0.7, 1)
        collection = Poly3DCollection(corners, facecolors=colors, **style)
        axes.add_collection3d(collection)
        _bar(axes, low, high)
    _fit(axes, vertices)
    return axes


def _bar(axes: typing.Any, low: float, high: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    axes.figure.colorbar(ScalarMappable(Normalize(low, high), "viridis"), ax=axes, shrink=0.6)


def plot_axis(axis: MedialAxis, values: typing.Any, axes: typing.Any) -> typing.Any:
    """Faces coloured by the mean of their balls' values, and the edges that no face has."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    shown = numpy.asarray(values, dtype=float)
    if shown.shape != (len(axis),):
        raise ValueError(f"values: expected {len(axis)} of them, one for each ball, not {shown.shape}")
    axes = _axes(axes)
    vertices, faces = axis.vertices, axis.faces
    if len(faces):
        plot_mesh(vertices, faces, shown[faces].mean(axis=1), axes)
    of_faces = numpy.sort(numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [0, 2]]]), axis=1)
    alone = set(map(tuple, axis.edges.tolist())) - set(map(tuple, of_faces.tolist()))
    lines = numpy.array(sorted(alone)[:_EDGES_AT_MOST], dtype=int).reshape(-1, 2)
    axes.add_collection3d(Line3DCollection(vertices[lines], colors="black", linewidths=1))
    _fit(axes, vertices)
    return axes


def plot_spheres(spheres: Floats, axes: typing.Any) -> typing.Any:
    """Spheres as half-transparent surfaces."""
    axes = _axes(axes)
    angle, height = numpy.meshgrid(numpy.linspace(0, 2 * numpy.pi, 17), numpy.linspace(0, numpy.pi, 9))
    unit = numpy.stack([numpy.cos(angle) * numpy.sin(height), numpy.sin(angle) * numpy.sin(height), numpy.cos(height)])
    for x, y, z, radius in spheres.tolist():
        axes.plot_surface(x + radius * unit[0], y + radius * unit[1], z + radius * unit[2], alpha=0.25, linewidth=0)
    _fit(axes, numpy.concatenate([spheres[:, :3] - spheres[:, 3:], spheres[:, :3] + spheres[:, 3:]]))
    return axes
