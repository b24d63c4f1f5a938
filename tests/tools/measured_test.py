"""What a script measured for a page stays, and the page's tables with it, when a drawing fails at the end.

measured_test.py SOURCE, with a copy of tools/ and docs/ in a folder of its own and programs that are played.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = """#!/bin/sh
case $1 in
  medial)
    folder=$4
    mkdir -p "$folder"
    printf 'v 0 0 0 1\\nv 1 0 0 1\\nv 0 1 0 1\\nf 0 1 2\\n' > "$folder/lamp.ma"
    cp "$folder/lamp.ma" "$folder/lamp-simplified.ma"
    echo '{"seconds_of_few_balls": {"simplifying": 1}, "simplified": {"hausdorff_max": 0.25, "hausdorff_upper": 0.26}}'
    ;;
  *) echo "no screen" >&2; exit 1 ;;
esac
"""
EVALUATOR = """#!/bin/sh
echo '{"vertices": 4321, "hausdorff_max_pct": 1.5, "hausdorff_mean_pct": 0.5, "gap_max_pct": 1, "protrusion_max_pct": 0,
       "topology_equal": true, "diagonal": 2, "mesh_triangles": 12, "quality_mean": 0.75, "quality_below_0.1": 0, "border_turns": 0,
       "border_length": 1, "sheets": 3, "tiny_sheets": 0}'
"""


def script(file, text):
    file.write_text(text)
    file.chmod(0o755)
    return file


def fails_while_drawing(source, tool, arguments, data, page, row):
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for folder in ("tools", "docs", "data"):
            (root / folder).mkdir()
        (root / "docs/images").mkdir()
        (root / "docs/results").mkdir()
        for file in (tool, "measured.py"):
            shutil.copy(source / "tools" / file, root / "tools")
        shutil.copy(source / "docs" / page, root / "docs" / page)
        mesh = root / "data/lamp.obj"
        mesh.write_text("v 0 0 0\n")
        orchard, evaluator = script(root / "orchard", PROGRAM), script(root / "evaluator", EVALUATOR)
        script(root / "xvfb-run", "#!/bin/sh\nshift\nexec \"$@\"\n")
        done = subprocess.run([sys.executable, root / "tools" / tool, evaluator, "--orchard", orchard,
                               *[{"EVALUATOR": evaluator, "PICTURES": root / "pictures"}.get(word, word) for word in arguments]],
                              env={**os.environ, "PATH": f"{root}:{os.environ['PATH']}"}, capture_output=True, text=True)
        assert done.returncode != 0 and "no screen" in done.stderr, f"{tool}: {done.stdout}{done.stderr}"
        measured = json.loads((root / "docs" / data).read_text())
        assert "lamp" in measured["models"], f"{tool} lost what it measured"
        text = (root / "docs" / page).read_text()
        assert row in text, f"{tool} did not write its table"
        for part in text.split("<!-- begin: ")[1:]:
            assert f"<!-- end: {part.split(' -->')[0]} -->" in part, f"{tool} broke a mark"


def main():
    source = pathlib.Path(sys.argv[1])
    fails_while_drawing(source, "medial-axes", ["EVALUATOR", "--pictures", "PICTURES"], "results/medial-axes.json", "results/medial-axes.md",
                        "| lamp | 12 | 4321 |")
    fails_while_drawing(source, "few-balls", [], "results/few-balls.json", "results/medial-quality.md", "1.500 / 0.500, found 0.250, proven 0.260")


if __name__ == "__main__":
    main()
