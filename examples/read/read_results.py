"""Reads what orchard writes with NumPy alone: an axis, a tree and reports.

read_results.py FOLDER MODEL, after
    orchard medial MODEL.obj -o FOLDER --report --export npz
    orchard build MODEL.obj -o FOLDER --export npz
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

tree = np.load(folder / f"{model}-nodes.npz")
spheres, levels, parents = tree["spheres"], tree["level"], tree["parent"]
below = np.count_nonzero(parents == 0)
print(f"{len(spheres)} spheres on {levels.max() + 1} levels, the root of radius {spheres[0, 3]:.3g}, {below} below it")

axis_report = json.loads((folder / f"{model}-medial.json").read_text())
tree_report = json.loads((folder / f"{model}.json").read_text())
print(f"the axis is within {axis_report['quality']['hausdorff_max']:.3g} % of the diagonal")
print(f"the deepest level has inaccuracy {tree_report['levels'][-1]['mean_inaccuracy']:.3g} in the mean")
