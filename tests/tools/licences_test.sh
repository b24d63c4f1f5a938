#!/usr/bin/env bash
# Whether every file's licence is stated and its text is there, as `reuse lint` sees it. Usage: licences_test.sh SOURCE
set -euo pipefail
cd "$1"
if ! command -v reuse > /dev/null; then
  echo "skipped: needs the program reuse (Debian's package of that name)"
  exit 77
fi
if ! git rev-parse --git-dir > /dev/null 2>&1; then
  echo "skipped: outside of a git repository nothing tells sources from what was built beside them"
  exit 77
fi
reuse lint
