#!/usr/bin/env python3
"""Runs the command lines of pages: exit code 1 if one fails.

run_lines.py PROGRAM SOURCE FOLDER PAGE..    PAGE: relative to SOURCE; FOLDER: rebuilt, where the lines are run

Every line of a ```sh block is run by itself, in the order of the pages, in a folder that looks like the repository after
tools/demo: the bundled models, their trees (merged ones, which are made at once), and stand-ins for the files that the pages
leave to the reader. What two pages say is run once. What is not run is in NOT_RUN, with a reason; an entry that is in no page is a fault.
"""
import pathlib
import shutil
import subprocess
import sys
import time

# The line, or how it begins where the entry ends in "..".
BY_CI = "installs packages or builds for minutes; .ci/run does it"
NOT_RUN = {
    "README.md": {
        "tools/demo ..": BY_CI,
        "tools/test ..": BY_CI,
        "cmake --preset runtime-only ..": "builds for a minute; tools/check-runtime does it in .ci/run",
    },
    "CONTRIBUTING.md": {
        "tools/demo ..": BY_CI,
        "tools/test --long ..": "tests for an hour",
        "tools/test ..": BY_CI,
        "tools/lint ..": "needs clang-tidy and a build, and takes minutes",
        "tools/fuzz ..": "builds with clang, and takes a minute for each reader",
        "tools/docs ..": BY_CI,
        "tools/packages ..": BY_CI,
        "tools/check-runtime ..": BY_CI,
        "tools/web ..": BY_CI,
        "tools/follow PAGE ..": BY_CI + " with the pages that are followed from first to last",
        ".ci/run ..": "is what every change must pass",
    },
    "docs/guide/quick-start.md": {
        "tools/demo": BY_CI,
        "cmake ..": "builds for a minute; tools/follow does it in .ci/run",
        "out/example/approach ..": "is what the lines before it build",
    },
    "docs/reference/command-line.md": {
        "orchard view out/lamp/lamp.orchard --window": "needs a screen; viz.Window.DoesWhatItIsTold is at it",
        "orchard completion zsh ..": "writes outside of the folder; Completion.* of the tests of apps read what it says",
    },
    "docs/guide/web.md": {
        "tools/web ..": BY_CI,
        "cd web ..": "needs what the line before it builds; web/test/pack.test.mjs does it",
        "cd ../../my-project ..": "is the reader's own; web/test/pack.test.mjs does the same",
    },
    "docs/guide/batch.md": {
        "python3 ..": "needs Dask; apps.BatchEngines.dask runs it",
        "snakemake ..": "needs Snakemake; apps.BatchEngines.snakemake runs it",
        "sbatch ..": "needs Slurm; apps.BatchEngines.slurm and slurm-node run the script",
        "orchard batch merge out/slurm ..": "needs what the line before it makes",
        "examples/batch/parallel.sh ..": "is in the repository; apps.BatchEngines.parallel runs it",
    },
    "docs/design/voronoi.md": {"paraview ..": "needs a screen"},
}

SET_UP = """
for model in lamp faucet ship; do orchard build data/$model.obj -o out/$model --method merging --quiet; done
orchard build data/lamp.obj -o out/octree --method octree --depth 2 --no-views --quiet
cp out/octree/lamp.sph other.sph
orchard medial data/lamp.obj -o out/other --raw --samples 1500 --no-views --quiet
cp out/other/lamp.ma other.ma
cp out/other/lamp.ma older.ma
mkdir -p results/results
cp data/lamp.obj results/lamp.obj
cp out/other/lamp.ma results/results/lamp-other-4000.ma
awk '$1 == "v" {print $2, $3, $4}' data/lamp.obj > cloud.xyz
grep '^v ' data/lamp.obj > vertices.obj
(printf 'ply\\nformat ascii 1.0\\nelement vertex %s\\n' "$(wc -l < cloud.xyz)"
 printf 'property float x\\nproperty float y\\nproperty float z\\nend_header\\n'; cat cloud.xyz) > cloud.ply
mkdir -p .local/share/bash-completion/completions
"""


def lines_of(page):
    inside = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("```"):
            inside = line.strip() == "```sh"
        elif inside and line.strip():
            yield number, line


def entry_of(line, entries):
    return next((entry for entry in entries
                 if line == entry or entry.endswith("..") and (line + " ").startswith(entry[:-2])), None)


def run(script, folder, environment):
    return subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False)


def main():
    program, source, folder, *pages = sys.argv[1:]
    source, folder = pathlib.Path(source).resolve(), pathlib.Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "data").symlink_to(source / "data")
    environment = {"PATH": f"{pathlib.Path(program).resolve().parent}:/usr/local/bin:/usr/bin:/bin", "HOME": str(folder),
                   "LC_ALL": "C.UTF-8"}
    ready = run(SET_UP, folder, environment)
    assert ready.returncode == 0, ready.stdout
    ran, failures = set(), 0
    for page in pages:
        unused = dict(NOT_RUN.get(page, {}))
        for number, line in lines_of(source / page):
            entry = entry_of(line, NOT_RUN.get(page, {}))
            unused.pop(entry, None)
            command = line.split("  #")[0].rstrip()
            if entry or command in ran:
                continue
            ran.add(command)
            begin = time.monotonic()
            finished = run(line, folder, environment)
            print(f"{time.monotonic() - begin:6.1f} s  {page}:{number}: {line}")
            if finished.returncode != 0:
                failures += 1
                print(f"exit code {finished.returncode}: {finished.stdout}")
        for entry in unused:
            failures += 1
            print(f"{page} has no line {entry}: take it from the list of what is not run")
    print(f"{len(ran)} lines run, {failures} faults")
    sys.exit(1 if failures else 0)


main()
