#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes the pages of scene keys from what the programs say of themselves by --help-scene, or checks that they are up to date, for
# the programs that are in the folder.
# usage: make.sh [--check] BIN_FOLDER
set -eu
check=no
[ "$1" != --check ] || { check=yes; shift; }
bin=$1
here=$(cd "$(dirname "$0")" && pwd)
fresh=$(mktemp)
trap 'rm -f "$fresh"' EXIT

# usage: page PROGRAM
page() {
  "$bin/$1" --help-scene | awk -v program="$1" '
    function cell(text) { gsub(/\|/, "\\|", text); return text }
    function flush(   default_value, unit, bound) {
      if (key == "") return
      default_value = required ? "**must be given**" : value == "" ? "-" : "`" value "`"
      printf "| `%s` | %s | %s | %s | %s |\n", key, default_value, unit_text == "" ? "" : unit_text, cell(kind), cell(sentence)
      key = ""
    }
    NR == 1 {
      print "# Keys of `" program "`\n"
      print "Made from `" program " --help-scene` by [make.sh](make.sh). A key that is not given has its default; `-` says that something"
      print "else follows from it, which its meaning tells. `--set section.key=value` replaces a key on the command line.\n"
      next
    }
    /^\[/ {
      flush()
      if (NR > 3) print ""
      print "## " $0 "\n"
      print "| key | default | unit | what it may be | meaning |\n|---|---|---|---|---|"
      next
    }
    /^  [^ ]/ {
      flush()
      line = substr($0, 3)
      open = index(line, "  (")
      head = substr(line, 1, open - 1)
      kind = substr(line, open + 3); sub(/\)$/, "", kind)
      unit_text = ""
      if (match(kind, /; \[[^]]*\]$/)) { unit_text = substr(kind, RSTART + 3, RLENGTH - 4); kind = substr(kind, 1, RSTART - 1) }
      required = sub(/: must be given$/, "", head)
      value = ""
      if ((equals = index(head, " = ")) > 0) { value = substr(head, equals + 3); head = substr(head, 1, equals - 1) }
      gsub(/finite and > 0, in any unit from 1e-30 to 1e\+30/, "> 0", kind)
      gsub(/finite, in any unit from -1e\+30 to 1e\+30/, "any", kind)
      key = head; sentence = ""
      next
    }
    /^      / { sentence = substr($0, 7) }
    END { flush() }'
}

failed=0
seen=0
for program in weave textile fabric_loading composite strand strand_bending two_ply knot tow fall yarn mat dense_mat; do
  [ -x "$bin/$program" ] || continue
  seen=$((seen + 1))
  page "$program" > "$fresh"
  [ "$(grep -c '^| `' "$fresh")" -gt 5 ] || { echo "$program --help-scene tells of no keys"; exit 1; }
  if [ $check = no ]; then
    cp "$fresh" "$here/$program.md"
    chmod 644 "$here/$program.md"
  elif ! cmp -s "$fresh" "$here/$program.md"; then
    echo "docs/reference/$program.md is not what $program says: sh docs/reference/make.sh $bin"
    diff "$here/$program.md" "$fresh" | head -10 || true
    failed=1
  fi
done
[ $seen -gt 0 ] || echo "no program is in $bin: nothing was done"
exit $failed
