"""Reads what orchard writes with NumPy alone: an axis, a tree and a report.

read_results.py FOLDER MODEL, after
    orchard medial MODEL.obj -o FOLDER --export npz
    orchard build MODEL.obj -o FOLDER
"""
import json
import pathlib
import sys

import numpy as np

folder, model = pathlib.Path(sys.argv[1]), sys.argv[2]

axis = np.load(folder / f"{model}-axis.npz")
centers, radii = axis["balls"][:, :3], axis["balls"][:, 3]
touching = np.linalg.norm(axis["contacts"] - centers[axis["contact_ball"]], axis=1)
print(f"{len(radii)} balls, radii {radii.min():.3g} to {radii.max():.3g}, {len(axis['triangles'])} triangles")
print(f"contacts are off the radius by {np.abs(touching - radii[axis['contact_ball']]).max():.2g} at most")

with open(folder / f"{model}.sph") as file:
    levels, branching = map(int, file.readline().split())
nodes = np.loadtxt(folder / f"{model}.sph", skiprows=1, comments="#")
spheres = nodes[nodes[:, 3] > 0]
print(f"{len(spheres)} spheres on {levels} levels, the root of radius {spheres[0, 3]:.3g}")

report = json.loads((folder / f"{model}.json").read_text())
print("the tree was made from", report["provenance"]["inputs"][0]["file"])
