#!/usr/bin/env bash
# The simulator's window under Xvfb: pictures are drawn, and change with what they are to show; exit code 77 says that
# there is no Xvfb. Usage: fly_test.sh FLY WRITER FOLDER    WRITER: makes a sample tree; FOLDER: for it and the pictures
set -euo pipefail
fly=$1 writer=$2 folder=$3

rm -rf "$folder"
mkdir -p "$folder"
"$writer" "$folder/torus.orchard"
refuses_without_display() { # refuses_without_display VARIABLE..: one line, as "orchard view --window" has it
  local status=0
  env "$@" "$fly" "$folder/torus.orchard" flight --frames 1 2> "$folder/errors.txt" || status=$?
  [ "$status" -eq 1 ] && [ "$(wc -l < "$folder/errors.txt")" -eq 1 ] && grep -q 'no window was opened' "$folder/errors.txt" ||
    { cat "$folder/errors.txt"; echo "without a display it ends with $status"; exit 1; }
}
refuses_without_display -u DISPLAY
refuses_without_display DISPLAY=:64999

if ! command -v xvfb-run > /dev/null || ! command -v Xvfb > /dev/null; then
  echo "skipped: the window needs a display, and there is no Xvfb (package xvfb) to give it one"
  exit 77
fi
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
