#!/bin/sh
# SPDX-License-Identifier: MIT
# All code has the format of .clang-format (clang-format 14: versions differ), or is given it.
# usage: format.sh [--fix] PROJECT_FOLDER [CLANG_FORMAT]
set -eu
how="--dry-run -Werror"
[ "$1" != --fix ] || { how=-i; shift; }
cd "$1"
formatter=${2:-clang-format-14}
# shellcheck disable=SC2086
find include compiled tests examples benchmarks \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 "$formatter" $how
