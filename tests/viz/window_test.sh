#!/usr/bin/env bash
# The window of "orchard view", on a display of its own, as a user works with it; exit code 77 says why it could not be tried.
# Usage: window_test.sh SOURCE ORCHARD FOLDER
set -euo pipefail
source=$1 orchard=$2 folder=$3
for program in python3 Xvfb; do
  command -v "$program" > /dev/null || { echo "skipped: there is no $program"; exit 77; }
done
rm -rf "$folder"
"$orchard" build "$source/data/ship.obj" -o "$folder" --method octree --depth 2 --no-views --quiet
python3 "$source/tests/viz/window_test.py" "$orchard" "$folder/ship.orchard" "$source/data/ship.obj" "$folder"
