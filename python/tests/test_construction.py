"""Medial axes, thickness, trees and sets: what Python makes of them, and that it is what the command makes."""
import pickle
import subprocess
import sys
import types

import numpy
import pytest

import orchard_geometry as og
from orchard_geometry import _construction


def test_an_axis_has_arrays_and_structure(box_axis):
    axis = box_axis
    count = len(axis)
    assert axis.vertices.shape == (count, 3) and axis.radii.shape == (count,)
    assert axis.edges.max() < count and axis.faces.shape[1] == 3 and (axis.radii >= 0).all()
    structure = axis.structure
    assert structure.count("sheet") >= 5 and len(structure.of_face) == len(axis.faces)
    assert structure.of_vertex.max() < len(structure.kinds) == len(structure.vertices)
    assert axis.topology() == {"components": 1, "loops": 0, "cavities": 0}
    assert axis.mesh.signed_distance(axis.vertices).max() < 1e-9
    angles = axis.contact_angle[axis.radii > 0]
    assert numpy.nanmax(angles) > 3 and "balls" in repr(axis) and "<table>" in axis._repr_html_()
    assert axis.report["promise_kept"] and axis.report["seconds"]
    for values in axis.importance().values():
        assert len(values) == count


def test_every_tuning_option_of_the_command_is_a_keyword(box):
    import inspect

    known = set(og.tuning_options())
    assert known <= set(inspect.signature(og.medial_axis).parameters)
    names = {row["name"].replace(" ", "-") for row in _construction.tuning_table()}  # "prune angle" is prune_angle
    assert names - {"segment-angle"} == {name.replace("_", "-") for name in known}
    raw = og.medial_axis(box, samples=200, refine=False, gaps="strict", seed=3, iterations=10, thin=False)
    assert len(raw) > 0 and raw.report["points"] <= 200
    assert len(raw.prune(angle=60)) < len(raw)


@pytest.mark.parametrize("options, words", [
    ({"samples": 3}, "samples.*20"), ({"gaps": "some"}, "gaps.*connected"), ({"edge_samples": 6000}, "edge-samples"),
    ({"refine": False, "border_loss": 1}, "no effect"), ({"border_loss": -1}, "border-loss"), ({"seed": 1.5}, "seed"),
    ({"linear_error": float("nan")}, "linear-error"), ({"side": "above"}, "side"), ({"samples": [1]}, "samples"),
    ({"points": [[0, 0, 0]]}, "four"), ({"features": [[0, 99]]}, "features"), ({"progress": 7}, "progress")])
def test_bad_options_are_refused_by_name(box, options, words):
    with pytest.raises((ValueError, TypeError), match=words):
        og.medial_axis(box, **options)


def test_an_axis_is_saved_and_read(box, box_axis, tmp_path):
    for ending in ("ma", "ply", "obj", "off", "sph", "cg", "txt", "xyz", "xyzr", "balls", "ma_struct"):
        file = tmp_path / f"axis.{ending}"
        box_axis.save(file)
        again = og.MedialAxis.load(file, box)
        assert len(again) == len(box_axis), ending
        assert numpy.sort(again.radii) == pytest.approx(numpy.sort(box_axis.radii), abs=1e-6), ending
        if ending in ("ma", "ply", "obj", "ma_struct"):
            assert (again.faces == box_axis.faces).all()
    box_axis.save(tmp_path / "axis.graphml")
    assert "graphml" in (tmp_path / "axis.graphml").read_text()
    with pytest.raises(ValueError, match=".swc"):
        box_axis.save(tmp_path / "axis.swc")
    (tmp_path / "bad.ma").write_text("1 0 0\nv 0 0 zero 1\n")
    with pytest.raises(og.MeshError, match="bad.ma.*2"):
        og.MedialAxis.load(tmp_path / "bad.ma", box)


def test_an_axis_of_another_system(box):
    axis = og.MedialAxis.of(box, [[-0.4, 0, 0], [0.4, 0, 0]], [0.4, 0.4], [[0, 1]])
    assert len(axis.edges) == 1 and axis.structure.count("curve") == 1 and numpy.isnan(axis.contact_angle).all()
    assert len(axis.structure_graph().arcs) == 1 and axis.structure_graph().arcs[0].length == pytest.approx(0.8)
    assert axis.quality(samples=500)["hausdorff_max"] > 5
    for wrong in ({"radii": [0.4]}, {"radii": [0.4, -1]}, {"edges": [[0, 2]]}, {"faces": [[0, 0, 1]]}):
        with pytest.raises(ValueError):
            og.MedialAxis.of(box, **{"vertices": [[-0.4, 0, 0], [0.4, 0, 0]], "radii": [0.4, 0.4], **wrong})


def test_axes_are_pickled(box_axis):
    again = pickle.loads(pickle.dumps(box_axis))
    assert (again.vertices == box_axis.vertices).all() and (again.faces == box_axis.faces).all()
    assert again.topology() == box_axis.topology()


def test_an_axis_is_judged_simplified_and_compared(box_axis):
    quality = box_axis.quality(samples=1000)
    assert quality["hausdorff_max"] < 1 and quality["topology_right"] == 1 and "hausdorff" in quality._repr_html_()
    few = box_axis.simplify(30)
    assert 0 < len(few) <= 30 and few.report["upper"] > 0
    assert box_axis.distance(few)["max"] > 0 and box_axis.distance(box_axis)["max"] < 1e-3
    envelope = box_axis.envelope(2)
    assert envelope.solid and envelope.volume == pytest.approx(box_axis.mesh.volume, rel=0.1)
    assert len(box_axis.structure_graph().nodes) > 0
    with pytest.raises(ValueError, match="simplify"):
        box_axis.simplify()
    with pytest.raises(TypeError, match="other"):
        box_axis.distance(3)


def test_an_axis_becomes_curves_and_parts_of_the_surface(tmp_path):
    axis = og.medial_axis(og.box_mesh([1, 2, 4]), samples=800)
    skeleton = axis.skeleton()
    assert len(skeleton.curves) == 1
    assert skeleton.curves[0].length == pytest.approx(4, abs=0.25)
    assert skeleton.radii == pytest.approx(numpy.ones(len(skeleton.vertices)))
    assert skeleton.topology() == {"components": 1, "loops": 0, "cavities": 0}
    assert len(skeleton.curves[0].vertices) == len(skeleton.vertices) == len(skeleton.edges) + 1
    skeleton.save(tmp_path / "box.swc")
    assert (tmp_path / "box.swc").read_text() == skeleton.text("swc")
    with pytest.raises(ValueError, match="ratio"):
        axis.skeleton(ratio=0.1)
    with pytest.raises(ValueError, match="pdf"):
        skeleton.save(tmp_path / "box.pdf")
    parts = axis.segment(by="sheets", faces=2000)
    assert sum(part["area"] for part in parts.parts) == pytest.approx(112)
    assert len(parts.part_of_face) == len(parts.mesh.faces) == len(parts.of_face)
    assert sum(len(parts.part_mesh(i).faces) for i in range(len(parts.parts))) == len(parts.mesh.faces)
    assert all(part["region"] is None for part in parts.parts)
    with pytest.raises(ValueError, match="part"):
        parts.part_mesh(len(parts.parts))


def test_offsets_have_proven_distances(box):
    grown = og.offset(box, 0.1, tolerance=2)
    assert grown.mesh.solid and grown.error <= grown.tolerance
    assert box.closest_points(grown.mesh.vertices).distances == pytest.approx(0.1, abs=grown.tolerance)
    assert grown.mesh.volume > box.volume > og.offset(box, 0.1, side="inside", tolerance=2).mesh.volume
    hollowed = og.hollow(box, 0.1, tolerance=2)
    assert hollowed.min_wall >= 0.1 and hollowed.mesh.volume < box.volume
    with pytest.raises(ValueError, match="distance"):
        og.offset(box, 0)
    with pytest.raises(og.MeshError, match="deeper"):
        og.hollow(box, 5)


def test_thickness(box):
    found = og.thickness(box, [[0, 0, 0.4], [0, 0, -0.4]])
    assert found.thickness == pytest.approx([0.8, 0.8])
    local = og.local_thickness(box, samples=500)
    assert local.at_faces.thickness.shape == (len(local.mesh.faces),)
    assert numpy.nanmin(local.at_faces.thickness) > 0.79
    thin = local.thin_places(0.9)
    assert thin.area > 0 and thin.regions and (thin.of_face >= -1).all() and not local.thin_places(0.1).regions
    assert og.thickness(box, [[0, 0, 0.4]], definition="ray").thickness[0] == pytest.approx(0.8)


def test_a_tree_is_certified_saved_and_used(lamp, lamp_tree, tmp_path):
    tree = lamp_tree
    assert tree.certificate and tree.verify(lamp) and tree.depth == 2 and len(tree.spheres(1)) <= 8
    assert not tree.verify(og.box_mesh())
    assert (tree.parents[1:] < numpy.arange(1, len(tree))).all() and (tree.errors > 0).all()
    assert len(tree.level_figures) == 3 and tree.report["points"] > 0
    spheres = tree.spheres(-1, complete=True)
    gaps = numpy.linalg.norm(lamp.vertices[:, None] - spheres[None, :, :3], axis=2) - spheres[:, 3]
    assert (gaps.min(axis=1) <= 1e-12).all()
    tree.save(tmp_path / "lamp.orchard")
    tree.save(tmp_path / "lamp.sph")
    again = og.SphereTree.load(tmp_path / "lamp.orchard")
    assert again.to_bytes() == tree.to_bytes() and again.certificate is None
    assert pickle.loads(pickle.dumps(tree)).certificate == tree.certificate
    text = og.SphereTree.load(tmp_path / "lamp.sph", lamp)
    assert text.certificate and len(text) == len(tree)
    assert og.collide(tree, tree, [[0.1, 0, 0, 1, 0, 0, 0], [50, 0, 0, 1, 0, 0, 0]]).touching.tolist() == [True, False]
    with pytest.raises(ValueError, match="mesh"):
        og.SphereTree.load(tmp_path / "lamp.sph")


@pytest.mark.parametrize("options, words", [
    ({"method": "best"}, "method"), ({"depth": 0}, "depth"), ({"branching": 1}, "branching"),
    ({"closing": "refit"}, "no effect"), ({"gaps": "none"}, "gaps has no effect"), ({"effort": "most"}, "effort"),
    ({"spheres": [8, 4]}, "spheres|4"), ({"spheres": [8], "depth": 1}, "excludes"), ({"regions": [[0, 0, 0, 1]]}, "regions"),
    ({"method": "octree", "samples": 100}, "samples"), ({"colour": 1}, "colour"), ({"seconds": -1}, "seconds"),
    ({"refine": True}, "refine"), ({"anneal_move": 0.1}, "anneal_move")])
def test_bad_tree_options_are_refused_by_name(box, options, words):
    with pytest.raises((ValueError, TypeError), match=words):
        og.sphere_tree(box, **options)


@pytest.mark.parametrize("method", ["merging", "annealing", "octree"])
def test_other_builders(box, method):
    effort = {"effort": "low"} if method == "annealing" else {}
    tree = og.sphere_tree(box, method=method, depth=1, **effort)
    assert tree.certificate and tree.depth == 1


def test_a_tree_of_an_axis_and_of_own_points(box, box_axis):
    assert og.sphere_tree(box, method="merging", depth=1, axis=box_axis).certificate
    assert og.sphere_tree(box, depth=1, effort="low", points=box.sample_surface(2000).points).certificate
    assert og.sphere_tree(box, depth=1, seconds=0.5).certificate


def test_sets_of_spheres(box, tmp_path):
    found = og.sphere_set(box, 6, effort="low")
    assert len(found) == 6 and found.kept and found.audit["covered"] and found.spheres.shape == (6, 4)
    inside = og.sphere_set(box, 6, fit="inside", effort="low")
    assert inside.kept and inside.audit["protrusion"][1] < 1e-6
    for ending in ("txt", "csv", "json"):
        found.save(tmp_path / f"set.{ending}")
    assert numpy.loadtxt(tmp_path / "set.txt") == pytest.approx(found.spheres)
    again = og.audit(numpy.loadtxt(tmp_path / "set.txt"), box)
    assert again["covered"] and again["solid_volume"] == pytest.approx(box.volume) and "covered" in repr(again)
    assert not og.audit([[0, 0, 0, 0.5]], box)["covered"]
    assert (pickle.loads(pickle.dumps(found)).spheres == found.spheres).all()
    for call in (lambda: og.sphere_set(box, 0), lambda: og.sphere_set(box, 5, fit="tight"), lambda: og.audit([], box),
                 lambda: og.audit([[0, 0, 0, -1]], box), lambda: og.sphere_set(box, 5, fit="inside", padding=1),
                 lambda: og.audit([[0, 0, float("nan"), 1]], box)):
        with pytest.raises(ValueError):
            call()


def test_particles_and_weights_of_sets(box):
    found = og.sphere_set(box, 12, fit="particles", particles=og.Particles(overlap=10, masses=True), effort="low")
    assert found.particles is not None and len(found.particles["masses"]) == 12
    assert found.particles["largest_overlap"] <= 0.1 and found.audit["protrusion"][1] < 1e-6
    assert sum(found.particles["masses"]) == pytest.approx(box.volume)
    corner = box.vertices[0]
    heavy = og.sphere_set(box, 6, fit="inside", weights=[(*corner, 1.0, 1000.0)], effort="low")
    plain = og.sphere_set(box, 6, fit="inside", effort="low")
    assert heavy.kept and not numpy.array_equal(heavy.spheres, plain.spheres)
    missed = og.sphere_set(box, 1, fit="inside", error=3, effort="low")
    assert not missed.error_reached and (missed.enough is None or missed.enough > 1)
    for call in (lambda: og.sphere_set(box, 4, weights=[(0, 0, 0, 1)]), lambda: og.sphere_set(box, 4, vertex_weights=[1]),
                 lambda: og.sphere_set(box, 4, weights=[(0, 0, 0, -1, 2)]),
                 lambda: og.sphere_set(box, 4, fit="particles", particles=og.Particles(overlap=-1))):
        with pytest.raises(ValueError):
            call()


def test_solids_are_clipped_and_united(box):
    half = box.clip([0, 0, 2], 0)
    assert half.solid and half.volume == pytest.approx(box.volume / 2)
    both = og.Mesh(numpy.concatenate([box.vertices, box.vertices * 0.5 + [0.9, 0.2, 0.1]]),
                   numpy.concatenate([box.faces, box.faces + len(box.vertices)]))
    united = both.unite()
    assert united.solid and united.volume < both.volume and og.inspect(united)["self_intersections"] == 0
    assert box.unite() is box
    with pytest.raises(og.MeshError):
        box.clip([0, 0, 1], 100)


def test_progress_is_reported_and_can_stop(lamp):
    seen = []
    og.medial_axis(lamp, samples=500, progress=lambda stage, done: seen.append((stage, done)))
    assert len({stage for stage, _ in seen}) > 2 and all(0 <= done <= 1 for _, done in seen)
    with pytest.raises(og.Cancelled):
        og.medial_axis(lamp, samples=500, progress=lambda stage, done: False)

    def fail(stage, done):
        raise KeyError(stage)

    with pytest.raises(KeyError):
        og.medial_axis(lamp, samples=500, progress=fail)


def test_ctrl_c_ends_building(data):
    code = """
import _thread, threading, time, sys
import orchard_geometry as og
mesh = og.load(sys.argv[1])
begin = []
def interrupt():
    begin.append(time.process_time())
    _thread.interrupt_main()
threading.Timer(0.5, interrupt).start()
try:
    og.sphere_tree(mesh, effort="high", depth=4)
except KeyboardInterrupt:
    print(time.process_time() - begin[0])
"""
    said = subprocess.run([sys.executable, "-c", code, str(data / "lamp.obj")], check=True, capture_output=True,
                          text=True, timeout=600).stdout
    assert said and float(said) < 2  # of the time of two processors


def test_the_same_bytes_as_the_command(data, program, tmp_path):
    lamp = data / "lamp.obj"
    subprocess.run([program, "medial", lamp, "-o", tmp_path, "--no-views", "--quiet", "--samples", "2000", "--seed", "3",
                    "--border-loss", "0.2"], check=True)
    og.medial_axis(lamp, samples=2000, seed=3, border_loss=0.2).save(tmp_path / "python.ma")
    ours, theirs = (tmp_path / "python.ma").read_bytes(), (tmp_path / "lamp.ma").read_bytes()
    assert theirs.startswith(ours) and theirs[len(ours):].startswith(b"# ")  # where the command's file comes from
    assert theirs[len(ours):].count(b"\n") == 1
    subprocess.run([program, "build", lamp, "-o", tmp_path, "--no-views", "--quiet", "--depth", "2", "--effort", "low"],
                   check=True)
    tree = og.sphere_tree(lamp, depth=2, effort="low")
    tree.save(tmp_path / "python.orchard")
    tree.save(tmp_path / "python.sph")
    assert (tmp_path / "python.orchard").read_bytes() == (tmp_path / "lamp.orchard").read_bytes()
    assert (tmp_path / "python.sph").read_bytes() == (tmp_path / "lamp.sph").read_bytes()


def test_pictures(box, box_axis):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert box.plot() is not None and box_axis.plot() is not None
    assert og.local_thickness(box, samples=100).plot() is not None
    assert og.Tree.box([1, 1, 1]).plot() is not None
    with pytest.raises(ValueError, match="values"):
        box.plot([1, 2])


def test_pyvista_is_asked_to_wrap(monkeypatch, box):
    monkeypatch.setitem(sys.modules, "pyvista", types.SimpleNamespace(wrap=lambda data: ("wrapped", data)))
    monkeypatch.setattr("orchard_geometry._vtk.polydata", lambda *arguments: "data")
    assert box.to_pyvista() == ("wrapped", "data")


def test_values_for_vtk(box, box_axis, lamp_tree):
    pytest.importorskip("vtkmodules")
    data = box.to_vtk()
    assert data.GetNumberOfPoints() == 8 and data.GetNumberOfPolys() == 12
    assert og.Mesh.of(data).volume == pytest.approx(box.volume)
    axis = box_axis.to_vtk()
    assert axis.GetNumberOfPolys() == len(box_axis.faces)
    assert axis.GetCellData().GetArray("structure").GetNumberOfTuples() == axis.GetNumberOfCells()
    assert lamp_tree.to_vtk(1).GetNumberOfPoints() == len(lamp_tree.spheres(1))
    assert og.local_thickness(box, samples=100).to_vtk().GetPointData().GetArray("thickness") is not None
