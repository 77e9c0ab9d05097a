#!/bin/sh
# SPDX-License-Identifier: MIT
# Each check fails on an input that breaks what it guards, says what is broken, and passes once it is mended.
# usage: self_test.sh COMPILER FLAG...
set -eu
checks=$(cd "$(dirname "$0")" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
failed=0

# header PATH: a sound header with the standard input as its body.
header() {
  mkdir -p "include/$(dirname "$1")"
  { printf '// SPDX-License-Identifier: MIT\n#pragma once\n/// @file A header.\n'; cat; } > "include/$1"
}
# refuses REGEX COMMAND...: the command fails and says so.
refuses() {
  expected=$1
  shift
  if said=$("$@" 2>&1); then
    echo "passes, but it must say '$expected': $*"
    failed=1
  elif ! printf '%s\n' "$said" | grep -qE "$expected"; then
    printf 'does not say "%s": %s\n%s\n' "$expected" "$*" "$said"
    failed=1
  fi
}
passes() {
  said=$("$@" 2>&1) || { printf 'fails on a sound input: %s\n%s\n' "$*" "$said"; failed=1; }
}
fresh() {
  rm -rf include
  echo 'inline int one() { return 1; }' | header fibrant/core/sound.hpp
  echo '#include <fibrant/core/sound.hpp>' | header fibrant/law/sound.hpp
  echo '#include <fibrant/core/sound.hpp>' | header fibrant/fibrant.hpp
  for folder in core law; do echo "#include <fibrant/$folder/sound.hpp>" | header fibrant/$folder.hpp; done
  echo '#include <fibrant/compositions/weave/sound.hpp>' | header fibrant/compositions.hpp
  echo 'struct Tow { int knots; };' | header fibrant/compositions/weave/sound.hpp
}

fresh
for check in folder_order vocabulary house_rules; do passes "$checks/$check.sh" include; done
passes "$checks/headers_alone.sh" include "$@"

echo '#include <fibrant/law/sound.hpp>' | header fibrant/core/upward.hpp
refuses 'core/upward.hpp:4: core comes before law' "$checks/folder_order.sh" include
fresh
echo '#include "sound.hpp"' | header fibrant/law/quoted.hpp
refuses 'law/quoted.hpp:4: .*quoted name' "$checks/folder_order.sh" include
fresh
echo '#include <fibrant/core/sound.hpp>' | header fibrant/misc/lost.hpp
refuses 'misc has no place in the order' "$checks/folder_order.sh" include
fresh
echo '#include <fibrant/fibrant.hpp>' | header fibrant/solver/all.hpp
echo '#include <fibrant/solver/all.hpp>' | header fibrant/solver.hpp
refuses 'solver/all.hpp:4: an umbrella' "$checks/folder_order.sh" include
fresh
echo 'inline int two() { return 2; }' | header fibrant/core/forgotten.hpp
refuses 'core.hpp does not include fibrant/core/forgotten.hpp' "$checks/folder_order.sh" include
fresh
echo '#include <fibrant/law/b.hpp>' | header fibrant/law/a.hpp
echo '#include <fibrant/law/c.hpp>' | header fibrant/law/b.hpp
echo '#  include <fibrant/law/a.hpp>' | header fibrant/law/c.hpp
refuses 'include each other:.*law/b.hpp' "$checks/folder_order.sh" include

for line in '// the warp is longer' 'double tow_spacing = 1.0;' 'struct KnotShape {};' 'int inWeaves;'; do
  fresh
  echo "$line" | header fibrant/contact/leak.hpp
  refuses 'contact/leak.hpp' "$checks/vocabulary.sh" include
done
fresh
printf '// towards the unknown, a stowed one\n' | header fibrant/contact/innocent.hpp
passes "$checks/vocabulary.sh" include

fresh
printf '#pragma once\n/// @file A header.\n' > include/fibrant/core/bare.hpp
refuses 'bare.hpp: the first line' "$checks/house_rules.sh" include
fresh
printf '// SPDX-License-Identifier: MIT\n/// @file A header.\n' > include/fibrant/core/unguarded.hpp
refuses 'unguarded.hpp: the second line' "$checks/house_rules.sh" include
fresh
printf '// SPDX-License-Identifier: MIT\n#pragma once\n' > include/fibrant/core/silent.hpp
refuses 'silent.hpp: no /// @file' "$checks/house_rules.sh" include
fresh
head -c 24000 /dev/zero | tr '\0' '/' | header fibrant/core/endless.hpp
refuses 'endless.hpp: 24[0-9]* bytes' "$checks/house_rules.sh" include
fresh
echo 'inline void say() { std::printf("."); }' | header fibrant/core/loud.hpp
refuses 'core/loud.hpp prints' "$checks/house_rules.sh" include
fresh
echo 'inline void say() { std::printf("."); }' | header fibrant/observe/loud.hpp
passes "$checks/house_rules.sh" include
echo '#include <nanoflann.hpp>' | header fibrant/proximity/once.hpp
passes "$checks/house_rules.sh" include
echo '#include <nanoflann.hpp>' | header fibrant/proximity/twice.hpp
refuses 'nanoflann.hpp> is included by more than one header' "$checks/house_rules.sh" include

fresh
mkdir tests
echo 'CHECK(x == test::near(y, 1e-12)), CHECK(a.isApprox(b))' > tests/sound_test.cpp
passes "$checks/house_rules.sh" include
echo 'CHECK(x == doctest::Approx(y).epsilon(1e-12))' > tests/swallowing_test.cpp
refuses 'tests/swallowing_test.cpp: numbers are compared by test::near' "$checks/house_rules.sh" include
rm -r tests

fresh
echo 'inline std::vector<int> none() { return {}; }' | header fibrant/core/dependent.hpp
refuses 'core/dependent.hpp does not compile alone' "$checks/headers_alone.sh" include "$@"
fresh
echo 'inline int cut(double x) { return x; }' | header fibrant/core/narrow.hpp
refuses 'core/narrow.hpp does not compile alone' "$checks/headers_alone.sh" include "$@"

printf '// expect: asserted\nint main() {}\n' > sound.cpp
refuses 'compiles, but it must be refused' "$checks/ill_formed.sh" sound.cpp "$@"
printf '// expect: the reason\nstatic_assert(false, "another matter");\n' > unnamed.cpp
refuses 'do not say: the reason' "$checks/ill_formed.sh" unnamed.cpp "$@"
printf 'static_assert(false);\n' > unexplained.cpp
refuses 'expects nothing' "$checks/ill_formed.sh" unexplained.cpp "$@"
{ echo '// expect: assert'; for k in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21; do echo 'static_assert(false);'; done; } > long.cpp
refuses 'lines, but at most 20' "$checks/ill_formed.sh" long.cpp "$@"
printf '// expect: the reason\nstatic_assert(false, "the reason");\n' > named.cpp
passes "$checks/ill_formed.sh" named.cpp "$@"

# Pages: links and headings that are there, and code as it stands in its file.
mkdir -p project/docs
page() {
  cat > project/docs/page.md
}
printf 'one\ntwo\nthree\n' > project/code.cpp
echo '# Read me' > project/README.md
printf '# A page: `b`\n[up](../README.md) [there](#a-page-b) [and](../README.md#read-me) `[no](link)`\n<!-- from code.cpp -->\n```\ntwo\nthree\n```\n' | page
passes sh "$checks/links.sh" project
echo '[gone](gone.md)' | page
refuses 'docs/page.md:1: gone.md leads nowhere' sh "$checks/links.sh" project
echo '[no heading](../README.md#me)' | page
refuses 'README.md#me: there is no such heading' sh "$checks/links.sh" project
printf '<!-- from code.cpp -->\n```\none\nthree\n```\n' | page
refuses 'docs/page.md:2: the code is not that of code.cpp' sh "$checks/links.sh" project

# Messages that are explained are said by something.
mkdir -p project/docs/how-to project/include project/examples
echo 'const char* said = "the run has stopped" + at;' > project/include/one.hpp
echo '### `the run has stopped ... here`' > project/docs/how-to/messages.md
passes sh "$checks/messages.sh" project
echo '### `the run has ended at ...`' > project/docs/how-to/messages.md
refuses 'explains "the run has ended at", which nothing says' sh "$checks/messages.sh" project

# Programs that take all, that say nothing of use, and that leave a folder behind.
echo '[knot]' > knot.toml
program() {
  { echo '#!/bin/sh'; cat; } > knot && chmod +x knot
}
echo 'exit 0' | program
refuses 'ended with status 0, not 2' sh "$checks/malformed.sh" ./knot knot.toml malformed 20
echo 'echo "knot: wrong"; exit 2' | program
refuses 'does not say' sh "$checks/malformed.sh" ./knot knot.toml malformed 20
echo 'while [ "$1" != --output ]; do shift; done; mkdir -p "$2"; exit 2' | program
refuses 'left a folder of results' sh "$checks/malformed.sh" ./knot knot.toml malformed 20
exit $failed
