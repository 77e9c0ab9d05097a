#!/bin/sh
# SPDX-License-Identifier: MIT
# Each message that docs/how-to/messages.md explains is one that headers or programs say: the words between dots of a heading stand in their text.
# What examples/support/remedies.hpp looks for in a reason is said by a header, and explained on that page.
# usage: messages.sh PROJECT_FOLDER
set -eu
cd "$1"
said=$(mktemp)
trap 'rm -f "$said"' EXIT
# Texts of one statement in one line, so that a message may be put together from pieces.
find include examples \( -name '*.hpp' -o -name '*.cpp' \) ! -name remedies.hpp | sort | xargs cat |
  grep '"' | sed 's/" *+ *"//g' > "$said"
sed -n 's/^### //p' docs/how-to/messages.md | tr '`' '\n' | sed 's/\.\.\./\n/g' | sed 's/^[ ,:(]*//; s/[ ,:()]*$//' | awk 'length($0) >= 10' | sort -u |
  while read -r words; do
    grep -qF -e "$words" "$said" || echo "docs/how-to/messages.md explains \"$words\", which nothing says"
  done | { ! grep .; }
sed -n 's/^    {"\([^"]*\)".*/\1/p' examples/support/remedies.hpp |
  while read -r words; do
    grep -qF -e "$words" "$said" || echo "examples/support/remedies.hpp looks for \"$words\", which nothing says"
    grep -q "^### .*$words" docs/how-to/messages.md || echo "docs/how-to/messages.md does not explain \"$words\""
  done | { ! grep .; }
