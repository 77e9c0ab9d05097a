#!/bin/sh
# SPDX-License-Identifier: MIT
# Every header compiles alone, included twice, without a warning. One that needs a header which the compiler does not
# find, and says so with `#if !__has_include(<...>)`, is left out.
# usage: headers_alone.sh [--together] INCLUDE_FOLDER COMPILER FLAG...
#   --together  all in one program: for a second compiler, with the same standard library, which takes a hundredth of the time
set -eu
together=no
[ "$1" = --together ] && together=yes && shift
include=$1
shift
export include
if [ $together = yes ]; then
  (cd "$include" && find fibrant -name '*.hpp' | sort) | while read -r header; do
    for needed in $(sed -n "s/^#if !__has_include(\(<[^>]*>\))$/\1/p" "$include/$header"); do
      printf "#if !__has_include(%s)\n#error\n#endif\n" "$needed" | "$@" -fsyntax-only -x c++ - 2>/dev/null || {
        echo "$header left out: $needed is not found" >&2
        continue 2
      }
    done
    echo "#include <$header>"
  done | "$@" -I"$include" -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -x c++ - ||
    { echo "the headers do not compile together with $1"; exit 1; }
  exit 0
fi
# What core/types.hpp includes from elsewhere takes longer than most headers: it is precompiled.
ready=$(mktemp -d)
export ready
trap 'rm -rf "$ready"' EXIT
types="$include/fibrant/core/types.hpp"
if [ -f "$types" ]; then grep '^#include <[^>]*>' "$types" | grep -v '<fibrant/'; fi > "$ready/external.hpp"
"$@" -I"$include" -Wall -Wextra -Wpedantic -Wconversion -Werror -x c++-header "$ready/external.hpp" -o "$ready/external.hpp.gch"
# Two at a time; xargs passes the failure of any on. Those of whole folders only include what is compiled here anyway.
(cd "$include" && find fibrant -mindepth 2 -name '*.hpp' | sort) | xargs -P 2 -I HEADER sh -c '
  header=$1
  shift
  for needed in $(sed -n "s/^#if !__has_include(\(<[^>]*>\))$/\1/p" "$include/$header"); do
    printf "#if !__has_include(%s)\n#error\n#endif\n" "$needed" | "$@" -fsyntax-only -x c++ - 2>/dev/null || {
      echo "$header left out: $needed is not found"
      exit 0
    }
  done
  printf "#include <%s>\n#include <%s>\n" "$header" "$header" |
    "$@" -include "$ready/external.hpp" -I"$include" -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -x c++ - ||
    { echo "$header does not compile alone with $1"; exit 1; }' headers_alone HEADER "$@"
