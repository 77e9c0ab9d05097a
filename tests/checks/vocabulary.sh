#!/bin/sh
# SPDX-License-Identifier: MIT
# Words of a composition do not occur in a component, neither alone nor as a part of a name. That of the
# compositions may include them.
# usage: vocabulary.sh INCLUDE_FOLDER
set -eu
cd "$1"
find fibrant -name '*.hpp' ! -path 'fibrant/compositions/*' | sort | while read -r header; do
  grep -n '' "$header" | { [ "$header" != fibrant/compositions.hpp ] && cat || grep -v '#include' || true; } |
    sed -E 's/([a-z0-9])([A-Z])/\1 \2/g; s/[_0-9]/ /g' |
    grep -iwE '(weave|woven|warp|weft|tow|resin|knot)s?' | sed "s|^|$header: |" || true
done | { ! grep .; }
