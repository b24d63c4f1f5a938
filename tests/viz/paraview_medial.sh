#!/usr/bin/env bash
# The presets of MODEL-medial-view.py, MODEL-medial.vtm and the recipes of docs/guide/paraview.md, tried where there is a ParaView;
# exit code 77 says why they could not be.
# Usage: paraview_medial.sh SOURCE ORCHARD FOLDER    FOLDER: where to make views and pictures
set -euo pipefail
source=$1 orchard=$2 folder=$3

status=0
"$source/tools/paraview" pvbatch --version > /dev/null || status=$?
if [ $status -eq 3 ]; then
  echo "skipped: the presets need ParaView, and there is none (the line above says what is missing)"
  exit 77
fi
rm -rf "$folder"
"$orchard" medial "$source/data/lamp.obj" -o "$folder" --raw --samples 1500 --light 300 --quiet
"$orchard" build "$source/data/lamp.obj" -o "$folder" --samples 1500 --effort low --depth 2 --quiet

# What ParaView says may be about the machine; a script that fails says so by a Traceback.
run() { "$source/tools/paraview" pvbatch "$@" 2> "$folder/errors.txt" || true; fail_on_errors; }
fail_on_errors() { ! grep -qE 'Traceback|Error:' "$folder/errors.txt" || { cat "$folder/errors.txt"; exit 1; }; }

for preset in radius sheets importance lines balls; do
  run "$folder/lamp-medial-view.py" --preset $preset -o "$folder/preset-$preset.png" --size 400 300 --balls 100 > "$folder/said-$preset.txt"
done
grep -qE '^[0-9]+ of [0-9]+ balls are drawn: the largest of each region, of which one in [0-9]+ \(--balls 100\)' "$folder/said-balls.txt"
run "$source/examples/paraview/recipes.py" "$folder" all -o "$folder/recipe.png"
run "$source/tests/viz/paraview_pictures.py" "$folder" | tee "$folder/words.txt"
grep -q 'all pictures are right' "$folder/words.txt"
