#!/bin/sh
# SPDX-License-Identifier: MIT
# Small textiles settle with a clean audit of topology and gaps; what cannot hold, and a wrong key, are refused before any work.
# usage: textile_example.sh <the program> <a scene in the folder of scenes> <scratch folder>
program=$1
scenes=$(dirname "$2")
out=$3
rm -rf "$out"
mkdir -p "$out" || exit 1
fail() {
  echo "textile_example: $*"
  exit 1
}
for name in braid_flat braid_tube interlock knit_plain tricot net chain_mail from_csv from_texgen; do
  text=$("$program" "$scenes/$name.toml" --output "$out/$name" --quiet --set output.paraview=false 2>&1) || {
    case $text in *"needs pugixml"*) continue ;; esac  # built without it
    fail "$name did not settle: $text"
  }
  for file in summary.json increments.csv yarns.csv centrelines.csv fibres.glb view.svg report.html; do
    [ -s "$out/$name/$file" ] || fail "$name: there is no $file"
  done
  for key in converged audit_clean topology_clean; do
    grep -q "\"$key\": true" "$out/$name/summary.json" || fail "$name: summary.json does not say that it is $key"
  done
done
for name in $(sed -n 's/^  "\([a-z_]*\)":.*/\1/p' "$out/tricot/summary.json") $(head -1 "$out/tricot/increments.csv" | tr ',' ' '); do
  grep -q "\`$name\`" "$(dirname "$0")/../../docs/reference/files.md" || fail "docs/reference/files.md has no $name"
done
refused() {
  text=$("$program" "$scenes/$1.toml" --output "$out/refused" --set "$2" 2>&1)
  [ $? -eq 2 ] || fail "$2 was not refused"
  case $text in
    *"$3"*) ;;
    *) fail "the refusal of $2 does not say $3: $text" ;;
  esac
}
refused braid_flat contact.frction=1 contact.frction
refused interlock 'levels.levels=["333333","012321"]' "comes apart"
refused interlock levels.column_spacing=0.1 levels.column_spacing
refused from_csv file.path=nowhere.csv nowhere.csv
exit 0
