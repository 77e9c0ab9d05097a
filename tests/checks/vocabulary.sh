#!/bin/sh
# SPDX-License-Identifier: MIT
# Words of a composition do not occur in a component, neither alone nor as a part of a name. That of the
# compositions may include them.
# usage: vocabulary.sh INCLUDE_FOLDER
set -eu
cd "$1"
find fibrant -name '*.hpp' ! -path 'fibrant/compositions/*' | sort | xargs awk '
  FILENAME == "fibrant/compositions.hpp" && /#include/ { next }
  {
    # Whole names, and the parts of those that capitals begin.
    words = $0 " "
    gsub(/[A-Z]/, " &", words)
    words = " " $0 " " words
    gsub(/[^A-Za-z]/, " ", words)
    if (tolower(words) ~ / (weave|woven|warp|weft|tow|resin|knot)s? /) { print FILENAME ":" FNR ": " $0; bad = 1 }
  }
  END { exit bad }'
