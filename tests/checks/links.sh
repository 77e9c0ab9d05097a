#!/bin/sh
# SPDX-License-Identifier: MIT
# Relative links of the README and of docs lead to files that are there, and to headings that are there. Code that says where it is from,
#   <!-- from PATH -->
# on the line before its fence, stands in that file line by line, in one piece.
# usage: links.sh PROJECT_FOLDER
set -eu
cd "$1"
pages=$(find . -maxdepth 1 -name '*.md'; find docs -name '*.md')
[ -n "$pages" ] || { echo "no pages in $1"; exit 1; }
tab=$(printf '\t')
problems=$(mktemp)
trap 'rm -f "$problems"' EXIT

# Headings as a code host and mkdocs name them: small letters, digits, dashes.
anchors() {
  awk '/^```/ { code = !code } !code && /^#+ / {
    sub(/^#+ +/, ""); $0 = tolower($0); gsub(/[^a-z0-9 _-]/, ""); gsub(/ /, "-"); print }' "$1"
}

# shellcheck disable=SC2086
awk '
  FNR == 1 { code = 0 }
  /^ *```/ { code = !code; next }
  code { next }
  { gsub(/`[^`]*`/, "")
    while (match($0, /\]\([^) ]+\)/)) {
      print FILENAME "\t" FNR "\t" substr($0, RSTART + 2, RLENGTH - 3)
      $0 = substr($0, RSTART + RLENGTH)
    } }' $pages | while IFS="$tab" read -r page line link; do
  case $link in http://* | https://* | mailto:*) continue ;; esac
  path=${link%%#*}
  target=$page
  [ -z "$path" ] || target=$(dirname "$page")/$path
  if [ ! -e "$target" ]; then
    echo "$page:$line: $link leads nowhere"
  else
    case $link in
      *.md#* | '#'*) anchors "$target" | grep -qxF -e "${link#*#}" || echo "$page:$line: $link: there is no such heading" ;;
    esac
  fi
done > "$problems"

# shellcheck disable=SC2086
awk '
  function load(path,   line) {
    if (path in size) return
    size[path] = 0
    while ((getline line < path) > 0) text[path, ++size[path]] = line
    close(path)
  }
  function check(   k, n) {
    load(from)
    for (k = 1; k + count - 1 <= size[from]; ++k) {
      for (n = 1; n <= count && text[from, k + n - 1] == code[n]; ++n) {}
      if (n > count) return
    }
    print FILENAME ":" begun ": the code is not that of " from
  }
  FNR == 1 { inside = 0; from = "" }
  /^<!-- from .* -->$/ { from = $3; next }
  /^```/ { if (!inside && from != "") { inside = 1; count = 0; begun = FNR; next }
           if (inside) { check(); inside = 0; from = "" } next }
  inside { code[++count] = $0 }' $pages >> "$problems"
cat "$problems"
[ ! -s "$problems" ]
