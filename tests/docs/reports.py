#!/usr/bin/env python3
"""Validates the reports of all commands by docs/reference/reports.schema.json.

reports.py PROGRAM SCHEMA FOLDER

Commands are run on a box, with few points and spheres, in FOLDER, which is replaced each time. Exit code 1 and a line for each report that the
schema does not allow; 77 where Python has no jsonschema.
"""
import json
import pathlib
import shutil
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: Python has no jsonschema")
    sys.exit(77)

BOX = """v 0 0 0
v 2 0 0
v 2 1 0
v 0 1 0
v 0 0 1
v 2 0 1
v 2 1 1
v 0 1 1
f 1 4 3
f 1 3 2
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
"""

ROBOT = """<robot name="two"><link name="a"><collision><geometry><mesh filename="box.obj"/></geometry></collision></link>
<link name="b"><collision><geometry><cylinder radius="1" length="2"/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 3"/></joint></robot>
"""

# Definition of the schema, command line; the files that earlier lines wrote are read by later ones.
RUNS = [
    ("build", "build box.obj -o tree --depth 2 --samples 300"),
    ("build", "build box.obj -o merged --depth 1 --samples 300 --method merging --descent 1 --error 0.4"),
    ("build", "build box.obj -o annealed --depth 1 --branching 4 --effort low --method annealing"),
    ("build", "build box.obj -o octree --depth 2 --method octree"),
    ("build_cost", "build box.obj -o cost --cost"),
    ("medial", "medial box.obj -o axis --samples 300 --report --quality-samples 500"),
    ("medial", "medial box.obj -o few --samples 300 --vertices 20 --envelope few/envelope.obj --envelope-cell 5 --raw"),
    ("medial", "medial box.obj -o judged --axis axis/box.ma --quality-samples 500"),
    ("medial", "medial box.obj -o outside --samples 300 --side outside --raw"),
    ("medial_sweep", "medial box.obj -o sweep --raw --sweep samples=200,300 --quality-samples 500"),
    ("inspect_mesh", "inspect box.obj --unit mm"),
    ("inspect_tree", "inspect tree/box.orchard"),
    ("inspect_axis", "inspect axis/box.ma"),
    ("spheres", "spheres box.obj -n 6 -o spheres --effort low"),
    ("spheres", "spheres box.obj -n 20 --fit particles --masses -o particles --effort low"),
    ("spheres", "spheres box.obj -n 6 --fit balanced --error-curve 2,4 -o balanced --effort low"),
    ("inspect_spheres", "inspect spheres/box-set.txt"),
    ("inspect_points", "inspect points.xyz"),
    ("audit", "audit spheres/box-set.txt box.obj"),
    ("audit", "audit spheres/box-set.txt box.obj --buffer 0.01"),
    ("robot", "robot robot.urdf -o robot --spheres 3 --effort low --states 20 --no-picture"),
    ("audit_robot", "audit robot/robot-curobo.yml robot.urdf"),
    ("sample", "sample box.obj -o points --samples 200"),
    ("voronoi", "voronoi box.obj --samples 100"),
    ("voronoi", "voronoi points.xyz --compare"),
    ("compare", "compare box.obj tree/box.orchard octree/box.sph"),
    ("compare_axes", "compare box.obj axis/box.ma few/box-simplified.ma --vertices 15 --samples 300 --quality-samples 500"),
    ("medial_sweep", "medial box.obj -o swept --samples 300 --sweep vertices=10,20 --keep --quality-samples 500"),
    ("verify", "verify tree/box.orchard box.obj"),
    ("collide", ["collide", "tree/box.orchard", "tree/box.orchard", "--pose", "1.5 0 0 1 0 0 0"]),
    ("profile", "profile tree/box.orchard --flights 5"),
    ("simulate", "simulate pile --tree tree/box.orchard --bodies 4 --frames 10 --budget 500"),
    ("thickness", "thickness box.obj -o thick --samples 200 --below 1.5"),
    ("skeleton", "skeleton box.obj -o skeleton --samples 300"),
    ("segment", "segment box.obj -o segment --samples 300 --triangles 500 --meshes"),
    ("offset", "offset box.obj -o offset --distance 0.2 --tolerance 3"),
    ("offset", "offset box.obj -o hollow --hollow 0.2 --tolerance 3 --unit mm --scale 10"),
]


def faults_of(program, schema, folder):
    definitions = schema["$defs"]
    for definition, line in RUNS:
        words = line if isinstance(line, list) else line.split()
        run = subprocess.run([program, *words, "--json"], cwd=folder, capture_output=True, text=True, check=False)
        if run.returncode not in (0, 5):
            yield f"{words}: exit code {run.returncode}: {run.stderr.strip()}"
            continue
        validator = jsonschema.Draft202012Validator({**schema, "$ref": f"#/$defs/{definition}"})
        report = json.loads(run.stdout)
        described = set(definitions["measures"]["properties"])
        for key in sorted(set(report.get("quality", described)) ^ described):
            yield f"{' '.join(words)}: the measure {key} is not in both the report and the schema's measures"
        for error in validator.iter_errors(report):
            path = ".".join(str(part) for part in error.absolute_path)
            yield f"{' '.join(words)}: {path}: {error.message[:300]}"
    unused = set(definitions) - {definition for definition, _ in RUNS} - referenced(schema)
    for name in sorted(unused):
        yield f"the schema's {name} is used by no report"


def referenced(value):
    if isinstance(value, dict):
        found = {value["$ref"].rsplit("/", 1)[1]} if "$ref" in value else set()
        return found.union(*(referenced(item) for item in value.values()))
    if isinstance(value, list):
        return set().union(*(referenced(item) for item in value))
    return set()


def main():
    program, schema_file, folder = sys.argv[1:]
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "few").mkdir()
    (folder / "box.obj").write_text(BOX)
    (folder / "robot.urdf").write_text(ROBOT)
    (folder / "points.xyz").write_text("".join(f"{i % 5} {i // 5 % 5} {i // 25 + 0.1 * i}\n" for i in range(60)))
    schema = json.loads(pathlib.Path(schema_file).read_text())
    faults = list(faults_of(program, schema, folder))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
