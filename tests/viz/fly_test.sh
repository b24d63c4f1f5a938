#!/usr/bin/env bash
# The simulator's window under Xvfb: pictures are drawn, and change with what they are to show; exit code 77 says that
# there is no Xvfb. Usage: fly_test.sh FLY WRITER FOLDER    WRITER: makes a sample tree; FOLDER: for it and the pictures
set -euo pipefail
fly=$1 writer=$2 folder=$3

if ! command -v xvfb-run > /dev/null || ! command -v Xvfb > /dev/null; then
  echo "skipped: the window needs a display, and there is no Xvfb (package xvfb) to give it one"
  exit 77
fi
rm -rf "$folder"
mkdir -p "$folder"
"$writer" "$folder/torus.orchard"
shoot() { # shoot NAME OPTIONS..
  xvfb-run -a -s '-screen 0 1280x1024x24' "$fly" "$folder/torus.orchard" flight --frames 4 --screenshot "$folder/$1.png" "${@:2}"
}
shoot plain
shoot spheres --level 1
shoot bounds --bounds
for name in plain spheres bounds; do
  [ "$(stat -c %s "$folder/$name.png")" -gt 8000 ] || { echo "$name.png shows next to nothing"; exit 1; }
done
if cmp -s "$folder/plain.png" "$folder/spheres.png"; then echo "spheres do not show"; exit 1; fi
if cmp -s "$folder/plain.png" "$folder/bounds.png"; then echo "bounds do not show"; exit 1; fi
status=0
"$fly" "$folder/none.orchard" 2> "$folder/errors.txt" || status=$?
[ "$status" -eq 2 ] && grep -q none.orchard "$folder/errors.txt" || { echo "a missing tree is not refused"; exit 1; }
