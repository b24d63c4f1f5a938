"""Meshes from arrays and from other libraries; what is asked of them; bad arrays."""
import math
import pickle
import types

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import orchard_geometry as og

TETRAHEDRON = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def test_arrays_are_given_back_as_views(box):
    assert box.vertices.shape == (8, 3) and box.vertices.dtype == numpy.float64 and not box.vertices.flags.writeable
    assert box.faces.shape == (12, 3) and box.faces.dtype == numpy.uint32
    assert box.vertices.base is not None
    assert box.solid and box.volume == pytest.approx(8 * 0.7 * 0.4) and box.faults == ""
    again = pickle.loads(pickle.dumps(box))
    assert (again.vertices == box.vertices).all() and (again.faces == box.faces).all()
    assert "8 vertices" in repr(box) and "<table>" in box._repr_html_()


@settings(max_examples=150, deadline=None)
@given(arrays.arrays(st.sampled_from([numpy.float64, numpy.float32, numpy.int64, numpy.complex64, "U2"]),
                     arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5)),
       arrays.arrays(st.sampled_from([numpy.int64, numpy.uint8, numpy.float64, numpy.bool_]),
                     arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5)))
def test_any_arrays_are_a_mesh_or_refused(vertices, faces):
    try:
        mesh = og.Mesh(vertices, faces)
        mesh.inspect()
        mesh.repair()
    except ValueError as error:
        assert str(error)


@pytest.mark.parametrize("vertices, faces, words", [
    ([[0, 0]], [[0, 0, 0]], r"vertices: expected the shape \(n, 3\)"),
    ([[0, 0, math.nan]], [[0, 0, 0]], r"vertices\[0\]: not a finite"),
    (TETRAHEDRON[0], [[0, 1, 4]], r"faces\[0\]: 4 is out of range; there are 4"),
    (TETRAHEDRON[0], [[0, 1, -1]], r"-1 is out of range"),
    (TETRAHEDRON[0], [[0.0, 1, 2]], "whole numbers"),
    (TETRAHEDRON[0], [], "triangle"), ([], [], "triangle|vertices"),
    (numpy.array(TETRAHEDRON[0]) * 1e20, TETRAHEDRON[1], "1e\\+?15")])
def test_what_is_no_mesh_is_refused_with_the_place(vertices, faces, words):
    with pytest.raises(ValueError, match=words):
        og.Mesh(vertices, faces)


def test_any_order_and_type_of_numbers_will_do():
    vertices, faces = numpy.array(TETRAHEDRON[0], dtype=float), numpy.array(TETRAHEDRON[1])
    for places in (numpy.asfortranarray(vertices), vertices.astype(">f8"), vertices.astype(numpy.int32),
                   numpy.repeat(vertices, 2, axis=0)[::2]):
        for corners in (faces.astype(numpy.uint8), numpy.asfortranarray(faces), faces.astype(numpy.int16)):
            assert og.Mesh(places, corners).volume == pytest.approx(1 / 6)
    vertices.flags.writeable = False
    assert og.Mesh(vertices, faces).solid


def test_a_mesh_is_copied_once():
    import tracemalloc

    side = numpy.linspace(0, 1, 200)
    x, y = numpy.meshgrid(side, side)
    vertices = numpy.stack([x.ravel(), y.ravel(), numpy.sin(5 * x.ravel())], axis=1)
    corner = (numpy.arange(199)[:, None] * 200 + numpy.arange(199)).ravel()
    faces = numpy.concatenate([numpy.stack([corner, corner + 1, corner + 200], axis=1),
                               numpy.stack([corner + 1, corner + 201, corner + 200], axis=1)]).astype(numpy.uint32)
    tracemalloc.start()
    mesh = og.Mesh(vertices, faces)
    taken = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert taken < vertices.nbytes / 2  # NumPy made no copy of it; C++ has its own
    tracemalloc.start()
    view = mesh.vertices
    taken = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert taken < 10_000 and len(view) == 40_000


def test_the_mesh_of_a_file(data, tmp_path):
    mesh = og.load(data / "lamp.obj")
    assert mesh.solid and og.inspect(mesh)["solid"] and og.inspect(data / "lamp.obj")["self_intersections"] == 0
    mesh.save(tmp_path / "again.obj")
    again = og.load(str(tmp_path / "again.obj"))
    assert (again.vertices == mesh.vertices).all() and (again.faces == mesh.faces).all()
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv x 1 0\nf 1 2 3\n")
    with pytest.raises(og.MeshError, match="bad.obj.*3"):
        og.load(tmp_path / "bad.obj")
    with pytest.raises(og.MeshError, match="none.obj"):
        og.load(tmp_path / "none.obj")
    with pytest.raises(ValueError, match=".obj"):
        mesh.save(tmp_path / "mesh.stl")


def test_meshes_of_other_libraries_by_what_they_have():
    vertices, faces = numpy.array(TETRAHEDRON[0], dtype=float), numpy.array(TETRAHEDRON[1])
    block = types.SimpleNamespace(type="triangle", data=faces)
    lines = types.SimpleNamespace(type="line", data=numpy.array([[0, 1]]))
    flat = numpy.concatenate([numpy.full((4, 1), 3), faces], axis=1).ravel()
    for thing in (types.SimpleNamespace(vertices=vertices, faces=faces),  # trimesh
                  types.SimpleNamespace(vertices=vertices, triangles=faces),  # Open3D
                  types.SimpleNamespace(points=vertices, cells=[lines, block]),  # meshio
                  types.SimpleNamespace(points=vertices, cells={"triangle": faces}),
                  types.SimpleNamespace(points=vertices, cells=[("triangle", faces)]),
                  types.SimpleNamespace(points=vertices, faces=flat),  # pyvista
                  (vertices, faces)):
        assert og.Mesh.of(thing).volume == pytest.approx(1 / 6)
    mixed = numpy.concatenate([[4, 0, 1, 3, 2], [3, 0, 1, 2]])
    assert og._duck.triangles_of_runs(mixed).tolist() == [[0, 1, 3], [0, 3, 2], [0, 1, 2]]
    with pytest.raises(TypeError, match="int"):
        og.Mesh.of(7)
    with pytest.raises(ValueError, match="tetra"):
        og.Mesh.of(types.SimpleNamespace(points=vertices, cells=[("tetra", [[0, 1, 2, 3]])]))


def test_meshio_as_it_is(data):
    meshio = pytest.importorskip("meshio")
    read = meshio.read(data / "ship.obj")
    assert og.Mesh.of(read).volume == pytest.approx(og.load(data / "ship.obj").volume)


def test_open3d_as_it_is(data):
    open3d = pytest.importorskip("open3d")
    read = open3d.io.read_triangle_mesh(str(data / "ship.obj"))
    assert og.Mesh.of(read).volume == pytest.approx(og.load(data / "ship.obj").volume, rel=1e-5)


def test_distances_are_negative_inside(box):
    points = [[0, 0, 0], [0, 0, 0.3], [3, 0, 0], [1, 0.7, 0.4]]
    assert box.signed_distance(points) == pytest.approx([-0.4, -0.1, 2, 0])
    assert box.contains(points[:3]).tolist() == [True, True, False]
    near = box.closest_points(points)
    assert near.distances == pytest.approx([0.4, 0.1, 2, 0]) and near.points[2] == pytest.approx([1, 0, 0])
    assert (near.faces < 12).all()
    assert og.signed_distance(box, [0, 0, 0]).shape == (1,)
    assert len(box.closest_points(numpy.zeros((0, 3)))) == 0
    opened = og.Mesh(box.vertices, box.faces[1:])
    with pytest.raises(og.MeshError, match="repair"):
        opened.signed_distance(points)


def test_repair_and_wrap(box):
    assert box.repair().mesh is box and box.repair().lines == []
    opened = og.Mesh(box.vertices, box.faces[1:])
    assert not opened.solid and "boundary" in opened.faults and not opened.repair().solid
    done = opened.repair(fill_holes=2)
    assert done.solid and done.mesh.volume == pytest.approx(box.volume) and done.lines
    with pytest.warns(og.RepairWarning, match="repaired"):
        og.thickness(og.Mesh(box.vertices, [box.faces[0][::-1], *box.faces[1:]]), [[0, 0, 0.4]])
    with pytest.raises(og.MeshError, match="not a closed"):
        og.thickness(opened, [[0, 0, 0.4]], strict=True)
    sheet = og.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(og.MeshError, match="even after repair.*wrap"):
        og.medial_axis(sheet)
    wrapped = og.wrap(sheet, alpha=0.1, offset=0.05)
    assert wrapped.mesh.solid and wrapped.to_input > 0
    with pytest.raises(ValueError, match="alpha"):
        sheet.wrap(alpha=0)


def test_points_of_the_surface(box):
    found = og.sample_surface(box, 500, seed=7)
    again = box.sample_surface(500, seed=7)
    assert (found.points == again.points).all() and not (found.points == box.sample_surface(500).points).all()
    assert box.closest_points(found.points).distances.max() < 1e-12
    assert 0 < found.on_edge.sum() <= 100 and len(found) <= 500
    for wrong in ({"samples": 3}, {"samples": 100.5}, {"edge_samples": 501}, {"relaxation": "none"}, {"seed": -1}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            box.sample_surface(**{"samples": 500, **wrong})


def test_a_diagram_of_points(box, tmp_path):
    points = box.sample_surface(100).points
    diagram = og.voronoi(points)
    assert diagram.vertices.shape == (len(diagram.radii), 3) and diagram.forming_sites.shape[1] == 4
    finite = diagram.finite
    nearest = numpy.linalg.norm(points[None] - diagram.vertices[finite][:50, None], axis=2).min(axis=1)
    assert nearest == pytest.approx(diagram.radii[finite][:50])
    assert len(diagram.cells()) == len(points) and diagram.faces()[0].shape[1] == 2
    assert diagram.inaccuracy()["max"] < 1e-9
    diagram.save(tmp_path / "points.vor")
    again = og.Voronoi.load(tmp_path / "points.vor")
    assert (again.forming_sites == diagram.forming_sites).all()
    assert (pickle.loads(pickle.dumps(diagram)).vertices == diagram.vertices).all()
    assert len(og.voronoi(points, algorithm="exact").radii) > 0
    with pytest.raises(ValueError, match="algorithm"):
        og.voronoi(points, algorithm="fast")
    with pytest.raises(ValueError, match="sites"):
        og.voronoi([[0, 0, math.inf]])


def test_threads_are_a_limit_and_no_result(box):
    with pytest.raises(ValueError, match="count"):
        og.set_threads(0)
    og.set_threads(1)
    one = box.sample_surface(400).points
    og.set_threads(None)
    assert (box.sample_surface(400).points == one).all()
