#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs an example that reads a scene file as a user would, and refuses a scene with a key that it does not know.
# usage: run_example.sh <the program> <scene file> <scratch folder>
program=$1
scene=$2
out=$3
rm -rf "$out"
mkdir -p "$out" || exit 1
fail() {
  echo "run_example: $(basename "$program"): $*"
  exit 1
}
"$program" "$scene" --output "$out" --quiet || fail "did not converge"
for file in summary.json increments.csv view.svg report.html paraview/fibres.pvd paraview/contacts.pvd; do
  [ -s "$out/$file" ] || fail "there is no $file"
done
for key in converged increments newton_iterations contact_elements greatest_penetration_over_radius wall_seconds version; do
  grep -q "\"$key\"" "$out/summary.json" || fail "summary.json has no $key"
done
grep -q '"converged": true' "$out/summary.json" || fail "summary.json does not say that it converged"
text=$("$program" "$scene" --output "$out/refused" --set contact.frction=1 2>&1)
[ $? -eq 2 ] || fail "a key that is not known was not refused"
case $text in
  *contact.frction*) ;;
  *) fail "the refusal does not name the key: $text" ;;
esac
exit 0
