#!/bin/sh
# SPDX-License-Identifier: MIT
# For other checks: whether two folders of results are the same but for clocks.
# A file of results without clocks and memory. Of an automatic solver its name: its solves are counted from where a program begins.
figures() {
  case $1 in
    *.csv) awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /second/ && $k !~ /moment/) clock[k] = 1 }
      { line = ""; for (k = 1; k <= NF; ++k) if (!(k in clock)) line = line $k ","; print line }' "$1" ;;
    *.json) awk '/"[a-z_]*seconds_by[a-z_]*": {/ { inside = 1 } { sub(/: solves by .*"/, "\"") } !inside && !/seconds"|memory/ { print } /}/ { inside = 0 }' "$1" ;;
    *) cat "$1" ;;
  esac
}
# What of a folder has to be the same: checkpoints have clocks in them, a report shows them.
results() {
  (cd "$1" && find . -type f ! -name '*.bin' ! -name '*.before' ! -name report.html | sort)
}
# usage: same_results <folder> <folder> <scratch folder>; what differs is in $difference.
same_results() {
  results "$1" > "$3/a.txt"
  results "$2" > "$3/b.txt"
  difference="other files: $(diff "$3/a.txt" "$3/b.txt" | head -3)"
  cmp -s "$3/a.txt" "$3/b.txt" || return 1
  while read -r file; do
    figures "$1/$file" > "$3/a.figures"
    figures "$2/$file" > "$3/b.figures"
    difference="another $file: $(diff "$3/a.figures" "$3/b.figures" | head -4 | cut -c 1-200)"
    cmp -s "$3/a.figures" "$3/b.figures" || return 1
  done < "$3/a.txt"
}
