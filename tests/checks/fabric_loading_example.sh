#!/bin/sh
# SPDX-License-Identifier: MIT
# Settles a small fabric with the example `weave` beside the program, releases its edges, and stretches it by a little.
# usage: fabric_loading_example.sh <the program> <scene file, not used> <scratch folder>
loading=$1
scenes=$(cd "$(dirname "$0")/../../examples" && pwd)
out=$3
weave=$(dirname "$loading")/weave
rm -rf "$out"
mkdir -p "$out" || exit 1
fail() {
  echo "fabric_loading_example: $*"
  exit 1
}
[ -x "$weave" ] || { echo "fabric_loading_example: left out, for there is no weave beside the program"; exit 0; }
. "$(dirname "$0")/small_fabric.sh"
"$weave" "$scenes/weave/plain.toml" --output "$out/settled" "$@" || fail "the small scene did not settle"
"$loading" "$scenes/fabric_loading/release.toml" --output "$out/released" --set "settled.set=[$list]" \
  --set settled.checkpoint="$out/settled/checkpoint.bin" --quiet || fail "edges were not released"
"$loading" "$scenes/fabric_loading/equibiaxial.toml" --output "$out/stretched" --set "settled.set=[$list]" --set stretch.increments=2 \
  --set 'stretch.ramps=["strain = 0.001"]' --set settled.checkpoint="$out/released/checkpoint.bin" --set output.paraview=false --quiet || fail "the fabric was not stretched"
for file in summary.json increments.csv curve.svg gap.svg before/view.svg after/slice_warp_0.svg after/sections.csv after/contacts.json after/strain_histogram.csv; do
  [ -s "$out/stretched/$file" ] || fail "there is no $file"
done
grep -q '"converged": true' "$out/stretched/summary.json" || fail "summary.json does not say that it converged"
text=$("$loading" "$scenes/fabric_loading/equibiaxial.toml" --output "$out/refused" --set loading.case=tickle --set settled.checkpoint="$out/released/checkpoint.bin" --set "settled.set=[$list]" 2>&1)
[ $? -eq 2 ] || fail "a case that is not known was not refused"
case $text in
  *tickle*) ;;
  *) fail "the refusal does not name the case: $text" ;;
esac
# What settled as one weave is no other, though it has the same fibres.
text=$("$loading" "$scenes/fabric_loading/release.toml" --output "$out/refused" --set "settled.set=[$list, 'fabric.pattern=[\"01\", \"10\"]']" \
  --set settled.checkpoint="$out/settled/checkpoint.bin" 2>&1) && fail "a weave was taken for another"
case $text in
  *"is of another scene: fabric.pattern ('plain' there and ['01', '10'] here)"*) ;;
  *) fail "the refusal of another pattern says: $text" ;;
esac
# As the scene file is, with no values replaced: all that is wrong is that nothing has been settled there.
text=$("$loading" "$scenes/fabric_loading/release.toml" --output "$out/refused" --set settled.checkpoint="$out/nowhere.bin" 2>&1)
case $text in
  *nowhere*) ;;
  *) fail "the scene file is not accepted as it is: $text" ;;
esac
exit 0
