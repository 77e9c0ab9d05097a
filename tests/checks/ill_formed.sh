#!/bin/sh
# SPDX-License-Identifier: MIT
# What must be refused is refused by the compiler, in at most 20 lines that name what is wrong. The file says
#   // expect: REGEX    each must be found in the diagnostics
#   // flags: FLAG...   added to the command line, if any
# usage: ill_formed.sh FILE COMPILER FLAG...
set -eu
file=$1
shift
flags=$(sed -n 's|^// flags: ||p' "$file")
grep -q '^// expect: ' "$file" || { echo "$file expects nothing"; exit 1; }

# shellcheck disable=SC2086
if diagnostics=$(LC_ALL=C "$@" $flags -fsyntax-only "$file" 2>&1); then
  echo "$file compiles, but it must be refused"
  exit 1
fi
failed=0
lines=$(printf '%s\n' "$diagnostics" | wc -l)
[ "$lines" -le 20 ] || { echo "$file is refused in $lines lines, but at most 20"; failed=1; }
sed -n 's|^// expect: ||p' "$file" | while read -r expected; do
  printf '%s\n' "$diagnostics" | grep -qE -e "$expected" || echo "the diagnostics do not say: $expected"
done | { ! grep .; } || failed=1
[ $failed -eq 0 ] || printf '%s\n' "$diagnostics"
exit $failed
