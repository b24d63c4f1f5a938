#!/usr/bin/env bash
# Whether tools/check-links finds fault with the repository's own pages, or, without a second argument, whether it finds what is
# wrong with a page and nothing else. Usage: pages_test.sh SOURCE [own]
set -euo pipefail
source=$1
if ! command -v python3 > /dev/null; then
  echo "skipped: tools/check-links needs python3"
  exit 77
fi
if [ "${2:-}" = own ]; then exec "$source/tools/check-links"; fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/docs/reference" "$folder/tests"

cat > "$folder/README.md" <<'PAGE'
# A page: with `code` in it
[right](docs/reference/dissertation.md), [its part](docs/reference/dissertation.md#the-part), [here](#a-page-with-code-in-it), [out](https://example.org/)
`[no link](nowhere.md)`
```
[nor this](nowhere.md)
```
PAGE
cat > "$folder/docs/reference/dissertation.md" <<'PAGE'
## The part
`First.Holds` `answer()` `space::answer` `orchard ask --deep` [`named.cpp`](../../tests/named.cpp)
PAGE
echo 'TEST(First, Holds) { space::answer("--deep"); }' > "$folder/tests/named.cpp"
"$source/tools/check-links" "$folder" || { echo "FAILED: it finds fault with pages that are right"; exit 1; }

cat >> "$folder/README.md" <<'PAGE'
[a](docs/nothing.md) [b](docs/reference/dissertation.md#no-part) [c](../outside.md)
PAGE
cat >> "$folder/docs/reference/dissertation.md" <<'PAGE'
`First.Fails` `question()` `orchard ask --shallow` [d](../../tests/moved.cpp)
PAGE
status=0
"$source/tools/check-links" "$folder" > "$folder/said" || status=$?
cat > "$folder/expected" <<'SAID'
README.md:7: ../outside.md leads out of the repository
README.md:7: docs/nothing.md leads to nothing
README.md:7: docs/reference/dissertation.md#no-part: there is no such heading
docs/reference/dissertation.md:3: ../../tests/moved.cpp leads to nothing
docs/reference/dissertation.md:3: no source has the name question
docs/reference/dissertation.md:3: no source has the option --shallow
docs/reference/dissertation.md:3: there is no test First.Fails
SAID
diff "$folder/expected" "$folder/said" || { echo "FAILED: it does not find what is wrong"; exit 1; }
[ "$status" = 1 ] || { echo "FAILED: exit code $status"; exit 1; }
