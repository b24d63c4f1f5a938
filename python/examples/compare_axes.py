"""Compares the axes of two systems of one solid by the same measures: here a refined and a raw one of orchard, the
second through a file as another program would write it."""
import argparse
import pathlib

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--quick", action="store_true", help="fewer points")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

mesh = og.load(arguments.data / "lamp.obj")
samples = 1000 if arguments.quick else 5000
og.medial_axis(mesh, samples=samples, refine=False).save(arguments.output / "theirs.ma")
systems = {"ours": og.medial_axis(mesh, samples=samples), "theirs": og.MedialAxis.load(arguments.output / "theirs.ma", mesh)}
judged = {name: axis.quality(samples=2000 if arguments.quick else 20_000) for name, axis in systems.items()}
print(f"{'measure':24}" + "".join(f"{name:>12}" for name in systems) + "  unit")
for measure in ("balls", "hausdorff_max", "hausdorff_mean", "coverage_max", "protrusion_max", "radius_error_max",
                "topology_right"):
    values = "".join(f"{quality.measures.get(measure, float('nan')):12.4g}" for quality in judged.values())
    print(f"{measure:24}{values}  {judged['ours'].units.get(measure, '')}")
apart = systems["ours"].distance(systems["theirs"])
print(f"The sheets are {apart['max'] / mesh.diagonal:.2%} of the diagonal apart at most, {apart['mean'] / mesh.diagonal:.3%} "
      "on average.")
