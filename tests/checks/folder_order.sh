#!/bin/sh
# SPDX-License-Identifier: MIT
# A folder includes only itself and those before it, headers are named <fibrant/...>, and no includes form a cycle. The umbrella
# of a folder, fibrant/FOLDER.hpp, has all of its headers but those that need a library of their own.
# usage: folder_order.sh INCLUDE_FOLDER
set -eu
cd "$1"
order='core scene beam term material solid proximity law contact connection load damping inertia assembly solver distributed observe exchange simulation compiled compositions'
failed=0

find fibrant -name '*.hpp' | sort | xargs grep -nE '^[[:space:]]*#[[:space:]]*include' /dev/null | awk -v order="$order" '
  function folder(path, part, n) { n = split(path, part, "/"); return n > 2 ? part[2] : "" }
  BEGIN { n = split(order, name, " "); for (k = 1; k <= n; ++k) rank[name[k]] = k }
  {
    split($0, field, ":"); from = field[1]; place = field[1] ":" field[2]
    if (match($0, /include[ \t]*"/)) { print place ": include <fibrant/...> instead of a quoted name"; bad = 1; next }
    if (!match($0, /<fibrant\/[^>]*>/)) next
    to = substr($0, RSTART + 1, RLENGTH - 2)
    if (to !~ /\/.*\//) { print place ": an umbrella is for users, no header includes it"; bad = 1; next }
    if (from !~ /\/.*\//) next
    if (!(folder(from) in rank)) { print place ": folder " folder(from) " has no place in the order"; bad = 1; next }
    if (!(folder(to) in rank)) { print place ": folder of " to " has no place in the order"; bad = 1; next }
    if (rank[folder(to)] > rank[folder(from)]) { print place ": " folder(from) " comes before " folder(to); bad = 1 }
  }
  END { exit bad }' || failed=1

for folder in $order; do
  [ -d "fibrant/$folder" ] || continue
  find "fibrant/$folder" -name '*.hpp' | sort | xargs -r grep -L '__has_include' | sed 's/.*/#include <&>/' |
    grep -vxF -f "fibrant/$folder.hpp" | sed "s|#include <\(.*\)>|fibrant/$folder.hpp does not include \1|" | { ! grep .; } || failed=1
done

# tsort takes pairs and names the members of a loop.
cycle=$(find fibrant -name '*.hpp' | sort | xargs grep -E '^[[:space:]]*#[[:space:]]*include[[:space:]]*<fibrant/' /dev/null |
  sed -E 's/^([^:]*):.*<([^>]*)>.*/\1 \2/' | tsort 2>&1 >/dev/null) ||
  { echo "these headers include each other: $(echo "$cycle" | sed -n 's/^tsort: fibrant/fibrant/p' | tr '\n' ' ')"; failed=1; }
exit $failed
