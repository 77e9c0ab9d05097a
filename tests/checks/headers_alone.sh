#!/bin/sh
# SPDX-License-Identifier: MIT
# Every header compiles alone, included twice, without a warning.
# usage: headers_alone.sh INCLUDE_FOLDER COMPILER FLAG...
set -eu
include=$1
shift
export include
# Two at a time; xargs passes the failure of any on.
(cd "$include" && find fibrant -name '*.hpp' | sort) | xargs -P 2 -I HEADER sh -c '
  header=$1
  shift
  printf "#include <%s>\n#include <%s>\n" "$header" "$header" |
    "$@" -I"$include" -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -x c++ - ||
    { echo "$header does not compile alone with $1"; exit 1; }' headers_alone HEADER "$@"
