"""A sweep over a folder: an axis and a tree of every mesh in it, one line each, as a table."""
import argparse
import csv
import pathlib

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--quick", action="store_true", help="fewer points, small trees")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

axis_options = {"samples": 800} if arguments.quick else {}
tree_options = {"depth": 1, "effort": "low"} if arguments.quick else {}
with open(arguments.output / "sweep.csv", "w", newline="", encoding="utf-8") as file:
    table = csv.writer(file)
    table.writerow(["model", "triangles", "balls", "sheets", "spheres", "certified", "remark"])
    for path in sorted(arguments.data.glob("*.obj")):
        try:
            mesh = og.load(path)
            axis = og.medial_axis(mesh, **axis_options)
            tree = og.sphere_tree(mesh, **tree_options)
        except og.MeshError as error:  # one bad file does not end the sweep
            table.writerow([path.stem, "", "", "", "", "", str(error)])
            continue
        row = [path.stem, len(mesh.faces), len(axis), axis.structure.count("sheet"), len(tree), tree.certificate.ok, ""]
        table.writerow(row)
        print("{:10} {:6} triangles, {:6} balls in {:3} sheets, {:4} spheres".format(*row[:5]))
