#!/bin/sh
# SPDX-License-Identifier: MIT
# What can be seen in the text of the headers: licence, guard and purpose first; short enough to be read in one sitting;
# no printing outside observe/; a third party's header (nanoflann, a solver library) included in one place. In the tests beside
# them numbers are compared by test::near: doctest's own Approx adds 1 to what it allows, and small numbers pass with any sign.
# usage: house_rules.sh INCLUDE_FOLDER
set -eu
cd "$1"
failed=0
complain() { echo "$1"; failed=1; }

find fibrant -name '*.hpp' | sort | xargs awk '
  function complain(what) { print what; bad = 1 }
  function close_file() {
    if (header == "") return
    if (!guarded) complain(header ": the second line is not #pragma once")
    if (!told) complain(header ": no /// @file sentence")
  }
  FNR == 1 {
    close_file()
    header = FILENAME; guarded = told = 0
    if ($0 != "// SPDX-License-Identifier: MIT") complain(header ": the first line is not the SPDX licence tag")
  }
  FNR == 2 && $0 == "#pragma once" { guarded = 1 }
  /^\/\/\/ @file / { told = 1 }
  header !~ /^fibrant\/observe\// && /std::(cout|cerr|clog)|printf *\(|(^|[^A-Za-z0-9_])puts *\(/ { complain(header " prints: " FNR ":" $0) }
  END { close_file(); exit bad }' || failed=1
find fibrant -name '*.hpp' | sort | xargs wc -c |
  awk '$2 != "total" && $1 > 24000 { print $2 ": " $1 " bytes, but at most 24000"; bad = 1 } END { exit bad }' || failed=1

# Standard headers have no suffix; Eigen's own are used everywhere, its bindings to other libraries are not.
for name in $(find fibrant -name '*.hpp' | sort | xargs sed -nE 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*<([^>]*)>.*/\1/p' |
  grep -E '\.h|Support$' | grep -v '^fibrant/' | sort | uniq -d); do
  complain "<$name> is included by more than one header: $(grep -rl --include='*.hpp' "<$name>" fibrant | sort | tr '\n' ' ')"
done

if [ -d ../tests ]; then
  for file in $(grep -rlw --include='*.hpp' --include='*.cpp' 'Approx' ../tests | grep -v '^../tests/near.hpp$' | sort); do
    complain "${file#../}: numbers are compared by test::near of tests/near.hpp, not by Approx"
  done
fi
exit $failed
