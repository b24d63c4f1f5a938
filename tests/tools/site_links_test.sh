#!/usr/bin/env bash
# Whether tools/site-links brings what pages link to onto the site, and names links that lead to nothing.
# Usage: site_links_test.sh SOURCE
set -euo pipefail
source=$1
if ! command -v python3 > /dev/null; then
  echo "skipped: tools/site-links needs python3"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/tools" "$folder/docs" "$folder/code/part" "$folder/site"
cp "$source/tools/site-links" "$folder/tools"
echo 'int main() {}' > "$folder/code/part/main.cpp"
echo 'MIT' > "$folder/code/LICENSE"
site=$folder/site
echo '<a href="code/LICENSE">a</a> <a href="https://example.org/x.html#y">b</a> <a href="md_docs_page.html#here">c</a>' > "$site/index.html"
echo '<h2 id="here"></h2><a href="../code/part/main.cpp">d</a> <a href="../code">e</a> <a href="#here">f</a>' > "$site/md_docs_page.html"
fail() { echo "FAILED: $1"; exit 1; }

"$folder/tools/site-links" "$site" || fail "it finds fault with links that are right"
"$folder/tools/site-links" "$site" || fail "a second time it does"
grep -q 'href="source/code/LICENSE.txt"' "$site/index.html" || fail "a file's link is not changed"
grep -q 'href="source/code/index.html"' "$site/md_docs_page.html" || fail "a folder's link is not changed"
cmp "$folder/code/part/main.cpp" "$site/source/code/part/main.cpp.txt" || fail "a file is not there"
grep -q 'href="part/index.html"' "$site/source/code/index.html" || fail "a folder's list has not its parts"

echo '<a href="page.md#there">g</a> <a href="../code/none.cpp">h</a> <a href="../../out">i</a> <a href="#gone">j</a>' > "$site/md_docs_wrong.html"
status=0
"$folder/tools/site-links" "$site" > "$folder/said" || status=$?
[ "$status" = 1 ] || fail "links to nothing pass"
for link in page.md#there ../code/none.cpp ../../out '#gone'; do
  grep -qF "md_docs_wrong.html: $link leads to nothing" "$folder/said" || fail "$link is not named"
done
[ "$(wc -l < "$folder/said")" = 4 ] || fail "others are named, too"
