#!/usr/bin/env bash
# Whether the examples that read results do so, in Python with NumPy and in Octave. Usage: read_results_test.sh SOURCE PROGRAM python|octave
set -euo pipefail
source=$1 program=$2 language=$3
case $language in
  python) reader=(python3) ; python3 -c 'import numpy' 2> /dev/null || { echo "skipped: NumPy is not installed"; exit 77; } ;;
  octave) reader=(octave-cli) ; command -v octave-cli > /dev/null || { echo "skipped: Octave is not installed"; exit 77; } ;;
esac
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" medial "$source/data/lamp.obj" -o "$folder" --samples 1500 --raw --no-views --quiet --export npz,csv --report --quality-samples 2000
"$program" build "$source/data/lamp.obj" -o "$folder" --depth 2 --effort low --no-views --quiet --export npz,csv
if [ "$language" = python ]; then
  "${reader[@]}" "$source/examples/read/read_results.py" "$folder" lamp > "$folder/said"
else
  "${reader[@]}" --eval "addpath('$source/examples/read'); read_results('$folder', 'lamp')" > "$folder/said"
fi
cat "$folder/said"
grep -qE '^[0-9]+ balls, radii ' "$folder/said"
grep -qE '^[0-9]+ spheres on 3 levels' "$folder/said"
grep -qE '^the axis is within [0-9.]+ % of the diagonal$' "$folder/said"
grep -qE '^the deepest level has inaccuracy [0-9.e-]+ in the mean$' "$folder/said"
grep -qE '^contacts are off the radius by [0-9.]+e-(0[6-9]|1[0-9]) at most$' "$folder/said"
