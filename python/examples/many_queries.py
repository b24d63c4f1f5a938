"""Asks 100,000 collision queries of two trees, and says how long one takes."""
import argparse
import pathlib
import time

import numpy

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--quick", action="store_true", help="a smaller tree and fewer queries")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

quick = {"depth": 1, "effort": "low"} if arguments.quick else {}
tree = og.sphere_tree(arguments.data / "lamp.obj", **quick)
tree.save(arguments.output / "lamp.orchard")

random = numpy.random.default_rng(1)
count = 10_000 if arguments.quick else 100_000
quaternions = random.normal(size=(count, 4))
quaternions /= numpy.linalg.norm(quaternions, axis=1, keepdims=True)
reach = 2 * tree.bounding_radius
poses = numpy.concatenate([random.uniform(-reach, reach, (count, 3)), quaternions], axis=1)

begin = time.perf_counter()
found = og.collide(tree, tree, poses)
seconds = time.perf_counter() - begin
print(f"{found}: {seconds / count * 1e6:.2f} microseconds each")
distances = og.distance(tree, tree, poses[found.apart][:1000])
print(f"The nearest of the first 1000 that are apart are {distances.upper.min():.3g} apart.")
