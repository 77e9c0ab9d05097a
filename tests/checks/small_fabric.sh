# SPDX-License-Identifier: MIT
# The fabric that checks of fabric_loading settle; read by them. Sets `list`, what `settled.set` repeats, and the arguments of weave.
small="fabric.warp_tows=2 fabric.weft_tows=2 fabric.elements=20 warp.fibres=3 warp.real_fibres=60 warp.aspect=1"
list=""
set -- --set output.paraview=false --set output.pictures=false --quiet
for value in $small; do
  set -- "$@" --set "$value"
  list="$list${list:+, }\"$value\""
done
