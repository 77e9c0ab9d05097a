#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds the documentation as a site, follows every link, and opens pages in a browser: no script fails, and the search finds a word.
# Without mkdocs the test is skipped, without a browser the second half of it.
# usage: site.sh PROJECT_FOLDER SCRATCH_FOLDER BROWSER        (BROWSER: chromium)
set -eu
project=$1
scratch=$2
browser=$3
here=$(cd "$(dirname "$0")" && pwd)
fail() {
  echo "site: $*"
  exit 1
}
command -v mkdocs > /dev/null || {
  echo "site: skipped, for there is no mkdocs (Debian: mkdocs)"
  exit 77
}
rm -rf "$scratch"
mkdir -p "$scratch"
PYTHONDONTWRITEBYTECODE=1 mkdocs build --strict --quiet -f "$project/.mkdocs.yml" -d "$scratch/site" || fail "mkdocs has complaints"
python3 "$here/site.py" "$scratch/site" || fail "see above"
[ -x "$browser" ] || {
  echo "site: no page was opened, for there is no browser (Debian: chromium)"
  exit 0
}
for page in 'index.html?q=damping' gallery.html; do
  sh "$here/in_browser.sh" "$browser" "file://$scratch/site/$page" "$scratch/dom.html" "$scratch" || fail "$page"
  case $page in
    *q=damping) grep -q '<article>.*settling.html' "$scratch/dom.html" || fail "the search does not find damping" ;;
  esac
done
