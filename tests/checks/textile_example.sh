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
  for file in summary.json increments.csv yarns.csv pairs.csv moves.csv centrelines.csv fibres.glb view.svg report.html; do
    [ -s "$out/$name/$file" ] || fail "$name: there is no $file"
  done
  for key in converged audit_clean topology_clean; do
    grep -q "\"$key\": true" "$out/$name/summary.json" || fail "$name: summary.json does not say that it is $key"
  done
done
for name in $(sed -n 's/^  "\([a-z_]*\)":.*/\1/p' "$out/tricot/summary.json") $(head -1 "$out/tricot/increments.csv" | tr ',' ' '); do
  grep -q "\`$name\`" "$(dirname "$0")/../../docs/reference/files.md" || fail "docs/reference/files.md has no $name"
done
# Seven straight fibres apart, in grips that end on nodes: a sample is as stiff as rods are. Pulled, E A each; moved aside, 12 E I / L^3;
# turned, E I + E A z^2, z being their height.
awk 'BEGIN { print "fibre,x,y,z"; for (f = 0; f < 7; ++f) for (k = 0; k <= 24; ++k) printf "%d,%.6f,%.6f,%.6f\n", f, 0.15 * k, 0.3 * (f % 3), 0.3 * int(f / 3) }' > "$out/straight.csv"
cat > "$out/straight.toml" <<'END'
textile.generator = "file"
file = { path = "straight.csv", crossings = "none" }
yarn = { radius = 0.05, young_modulus = 3000.0, poisson_ratio = 0.3 }
ends.kind = "free"
loading = { case = "tension", grip = 0.6, amount = 0.001, increments = 4 }
output = { surfaces = true, voxel_spacing = 0.1 }
END
# usage: stiffness CASE AMOUNT EXPRESSION [ACROSS]
stiffness() {
  "$program" "$out/straight.toml" --output "$out/$1" --quiet --set output.paraview=false --set "loading.case=$1" --set "loading.amount=$2" \
    --set "loading.across=${4:-z}" || fail "$1 of straight fibres"
  awk -v expression="$3" 'BEGIN { pi = atan2(0, -1); ea = 3000 * pi * 0.05 ^ 2; ei = 3000 * pi * 0.05 ^ 4 / 4; L = 2.4
      value["tension"] = 7 * ea; value["shear"] = 7 * 12 * ei / L ^ 2
      # heights 0 (3 fibres), 0.3 (3) and 0.6 (1) about their mean
      m = 1.5 / 7; value["bending"] = 7 * ei + ea * (3 * m ^ 2 + 3 * (0.3 - m) ^ 2 + (0.6 - m) ^ 2); want = value[expression] }
    /"initial_stiffness"/ { gsub(/[,"]/, ""); found = 1; if ($2 / want > 1.005 || $2 / want < 0.995) { print expression, $2, "instead of", want; exit 1 } }
    END { if (!found) exit 1 }' "$out/$1/loading/summary.json" || fail "the stiffness of straight fibres in $1"
}
stiffness tension 0.001 tension
stiffness shear 0.002 shear
stiffness bending 0.001 bending
# A cell that repeats: its six stiffnesses are symmetric. The others run on one thread, which is less work and comes to the same
# bits.
"$program" "$scenes/cell_plain.toml" --output "$out/cell" --quiet --set output.paraview=false || fail "the cell of a plain weave"
# Where crossings are near each other, errors of an increment would grow in the next ones.
"$program" "$scenes/cell_plain.toml" --output "$out/narrow" --threads 1 --quiet --set output.paraview=false \
  --set levels.warp_spacing=0.3 || fail "the cell of a plain weave whose warps are near each other"
for name in cell narrow; do
  awk '/"asymmetry"/ { gsub(/[,"]/, ""); found = 1; if ($2 > 2e-4) { print "asymmetry", $2; exit 1 } }
    END { if (!found) exit 1 }' \
    "$out/$name/loading/summary.json" || fail "the stiffness of a cell is not symmetric: $name"
done
# Planes of symmetry along its threads keep bending from shear and twist from strains without friction as well.
"$program" "$scenes/cell_plain.toml" --output "$out/frictionless" --threads 1 --quiet --set output.paraview=false \
  --set contact.friction_coefficient=0 || fail "a cell without friction"
sh "$(dirname "$0")/planes_of_symmetry.sh" "$out/frictionless/loading/stiffness.csv" || fail "planes of symmetry without friction"
# Threads that turn about their crossings like pins: against shear there is their tension alone, (N_x + N_y) / 4.
for name in cell narrow; do
  awk -F, 'FNR == 1 { for (i = 1; i <= NF; ++i) of[$i] = i }
    FILENAME ~ /increments/ && FNR == 2 { pins = ($of["n_x"] + $of["n_y"]) / 4 }
    $1 == "shear" { found = $of["n_xy"] }
    END { exit !(pins > 0 && found > 0.99 * pins && found < 1.01 * pins) }' \
    "$out/$name/loading/increments.csv" "$out/$name/loading/stiffness.csv" || fail "shear of a cell is not that of pins: $name"
done
for file in tows.yarns.stl tows.yarns.vtp tows.yarns.csv cells.vti cells.voxels.inp cells.voxels.csv cells.map.svg cells.profile.csv; do
  [ -s "$out/tension/$file" ] || fail "there is no $file"
done
refused() {
  scene=$scenes/$1.toml
  [ -f "$scene" ] || scene=$out/$1.toml
  text=$("$program" "$scene" --output "$out/refused" --set "$2" 2>&1)
  [ $? -eq 2 ] || fail "$2 was not refused"
  [ ! -e "$out/refused" ] || fail "$2 was refused after something was written"
  case $text in
    *"$3"*) ;;
    *) fail "the refusal of $2 does not say $3: $text" ;;
  esac
}
refused braid_flat contact.frction=1 contact.frction
refused interlock 'levels.levels=["333333","012321"]' "comes apart"
refused interlock levels.column_spacing=0.1 levels.column_spacing
refused chain_mail ends.kind=periodic ends.kind
refused cell_plain levels.columns=3 levels.columns
refused from_csv file.path=nowhere.csv nowhere.csv
refused knit_plain weft_knit.loop_height=0.41 "weft_knit.loop_height = 0.41, but it must be >= "
refused stitched stitched.row_spacing=0.7 "distance of thread"
refused stitched stitched.sideways=0 "comes apart"
refused braid_triaxial binder.radius=0.08 "binder.radius"
refused interlock 'levels.levels=["333333","01232"]' "levels.levels[1] = 5 columns"
sed '/^\[binder\]/,$d' "$scenes/orthogonal.toml" > "$out/bound.toml" && printf '[binder]\naspect = 0.5\n' >> "$out/bound.toml"
refused bound output.paraview=false "binder.aspect = 0.5, but it must be >= 1"
refused orthogonal 'levels.kinds=["binder"]' "levels.kinds = 1, but it must be one for each warp, 3"
# Ends that nothing holds: yarns that are straight at rest come off, if friction does not keep them.
refused braid_flat ends.kind=free "comes off the yarns that bend it"
refused yarn_plied ends.kind=free "unwind"
refused interlock ends.kind=free "contact.friction_coefficient >= 0."
# What comes after the settling is refused before it.
refused straight loading.grip=1.9 "loading.grip = 1.9, but it must be < half the length of the sample"
refused straight output.voxel_spacing=5.0 "output.voxel_spacing = 5, but it must be less than the sample is long"
refused straight output.voxel_spacing=1e-7 "output.voxel_spacing"
refused cell_plain loading.amount=0.5 "loading.amount = 0.5, but it must be from -0.1 to 0.1"
exit 0
