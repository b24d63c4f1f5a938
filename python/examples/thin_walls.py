"""Finds where a part is thinner than a limit: the places, their area, and a picture."""
import argparse
import pathlib

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--below", type=float, default=0.1, help="mesh units")
parser.add_argument("--quick", action="store_true", help="fewer triangles")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

mesh = og.load(arguments.data / "lamp.obj")
thickness = og.local_thickness(mesh, samples=2000 if arguments.quick else 20_000)
thin = thickness.thin_places(arguments.below)
print(f"{thin.area / thin.defined_area:.1%} of the surface is thinner than {arguments.below:g}, in {len(thin.regions)} places")
for region in thin.regions[:5]:
    print("  {:.4g} thick at ({:.3g}, {:.3g}, {:.3g}), area {:.3g}".format(
        region["min_thickness"], *region["thinnest"], region["area"]))
axes = thickness.plot()
axes.set_axis_off()
axes.view_init(elev=15, azim=35, vertical_axis="y")
axes.set_title(f"{thin.area / thin.defined_area:.0%} is thinner than {arguments.below:g}; grey: nothing faces the place")
axes.figure.savefig(arguments.output / "thin_walls.png", dpi=100, bbox_inches="tight")
