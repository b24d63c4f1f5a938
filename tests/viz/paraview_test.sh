#!/usr/bin/env bash
# The README's ParaView recipe, tried where there is a ParaView; exit code 77 says why it could not be.
# Usage: paraview_test.sh SOURCE ORCHARD FOLDER    FOLDER: where to make views and a picture
set -euo pipefail
source=$1 orchard=$2 folder=$3

status=0
"$source/tools/paraview" pvbatch --version > /dev/null || status=$?
if [ $status -eq 3 ]; then
  echo "skipped: the recipe needs ParaView, and there is none (the line above says what is missing)"
  exit 77
fi
rm -rf "$folder"
"$orchard" build "$source/data/lamp.obj" -o "$folder" --samples 1500 --effort low --depth 2 --quiet
"$source/tools/paraview" pvbatch "$source/tests/viz/paraview_recipe.py" "$source/README.md" "$folder"/*.vtm \
  "$folder"/*level?2.vtp "$folder/level_2.png" 2> "$folder/errors.txt" | tee "$folder/words.txt" || true
grep -q 'agree on' "$folder/words.txt" && ! grep -E 'Traceback|Error' "$folder/errors.txt" ||
  { cat "$folder/errors.txt"; exit 1; }

# What opens right by itself: the script and the state that were written beside the views, and orchard's own files by the plugin.
"$orchard" medial "$source/data/lamp.obj" -o "$folder" --raw --samples 1500 --no-views --quiet
"$orchard" voronoi "$source/data/lamp.obj" -o "$folder" --samples 300 --quiet
mkdir "$folder/axes"
cp "$source/data/lamp.obj" "$folder/axes/lamp.obj"
grep -v '^#' "$folder/lamp.ma" > "$folder/axes/lamp-other-100.ma"
"$orchard" leaderboard "$folder/axes" -o "$folder/axes/out" --builders raw --samples 300 --quality-samples 300 --quiet
"$source/tools/paraview" pvbatch "$folder/lamp-build-view.py" -o "$folder/view.png" --level 1 2> "$folder/errors.txt" || true
"$source/tools/paraview" pvbatch "$source/tests/viz/paraview_opens.py" "$source/viz/paraview/orchard_reader.py" "$folder" \
  2>> "$folder/errors.txt" | tee "$folder/words.txt" || true
grep -q 'ParaView opens all of it' "$folder/words.txt" && ! grep -E 'Traceback|Error' "$folder/errors.txt" ||
  { cat "$folder/errors.txt"; exit 1; }
