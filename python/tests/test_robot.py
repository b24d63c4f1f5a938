"""Spheres for robots from Python: what the command makes, as arrays."""
import numpy
import orchard_geometry as og
import pytest


@pytest.fixture(scope="module")
def arm(data):
    return og.robot(data / "desk-arm.urdf", 20, states=200, effort="low")


def test_every_link_has_spheres_that_are_proven(arm):
    assert len(arm) == 20 and arm.kept and len(arm.links) > 3
    for name, link in arm.links.items():
        assert link.name == name and len(link) >= 1 and link.audit["covered"] and not link.spheres.flags.writeable
    assert any(verdict == "Adjacent" for _, _, verdict in arm.pairs)


def test_spheres_move_with_their_links(arm):
    rest, poses = arm.spheres(), arm.poses()
    assert rest.shape == (20, 4) and set(arm.links) <= set(poses)
    for rows in arm.poses({"turn": 0.5, "lift": 0.3}).values():
        assert rows[:3, :3] @ rows[:3, :3].T == pytest.approx(numpy.eye(3))
    turned = arm.spheres({"turn": numpy.pi})
    assert turned[:, 2] == pytest.approx(rest[:, 2]) and abs(turned - rest).max() > 0.01
    with pytest.raises(og.MeshError, match="elbow of a snail"):
        arm.poses({"elbow of a snail": 1})


def test_formats_are_those_of_the_command(arm, tmp_path):
    files = arm.save(tmp_path / "out", "csv")
    text = open(files[0], encoding="utf-8").read()
    assert all(name in text for name in arm.links)
    with pytest.raises(ValueError, match="format"):
        arm.save(tmp_path, "pdf")


def test_what_makes_no_sense_is_refused(data, tmp_path):
    for call in (lambda: og.robot(data / "desk-arm.urdf", 0), lambda: og.robot(data / "desk-arm.urdf", 20, fit="tight"),
                 lambda: og.robot(data / "desk-arm.urdf", 20, links={"base": 0})):
        with pytest.raises(ValueError):
            call()
    with pytest.raises(og.MeshError, match="no link"):
        og.robot(data / "desk-arm.urdf", 20, links={"wing": 3})
    (tmp_path / "bad.urdf").write_text("<robot name='x'><link name='a'>")
    with pytest.raises(og.MeshError, match="bad.urdf"):
        og.robot(tmp_path / "bad.urdf")
