#!/bin/sh
# SPDX-License-Identifier: MIT
# Opens a page in a browser without a window or a network, lets its scripts run, and writes what it came to. A script that fails is told.
# usage: in_browser.sh BROWSER URL DOM_FILE SCRATCH_FOLDER        (BROWSER: chromium)
set -eu
browser=$1
url=$2
dom=$3
scratch=$4
mkdir -p "$scratch"
"$browser" --headless --no-sandbox --disable-gpu --window-size=1200,900 --virtual-time-budget=10000 --enable-logging=stderr \
  --host-resolver-rules="MAP * ~NOTFOUND" --user-data-dir="$scratch/profile" --dump-dom "$url" > "$dom" 2> "$scratch/log.txt" || {
  echo "$browser ended with an error: $(tail -n 3 "$scratch/log.txt")"
  exit 1
}
if grep -E 'CONSOLE.*(Uncaught|Error|ERR_)' "$scratch/log.txt"; then
  echo "a script of $url has an error"
  exit 1
fi
