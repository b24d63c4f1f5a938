"""Spheres for a link of a robot: twenty that hold the whole surface, proven, and as many that lie inside."""
import argparse
import pathlib

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--quick", action="store_true", help="fewer spheres, less search")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

link = og.load(arguments.data / "ship.obj")
count, effort = (6, "low") if arguments.quick else (20, "default")
for fit in ("cover", "inside"):
    found = og.sphere_set(link, count, fit=fit, effort=effort)
    found.save(arguments.output / f"link-{fit}.txt")
    audit = found.audit
    print(f"{fit}: {len(found)} spheres, promise {'kept' if found.kept else 'NOT kept'}; they stick out by "
          f"{audit['protrusion'][1]:.3g} at most, leave gaps of {audit['largest_gap'][1]:.3g}, and have "
          f"{audit['union_volume'] / audit['solid_volume']:.2f} times the volume")
