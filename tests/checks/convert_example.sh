#!/bin/sh
# SPDX-License-Identifier: MIT
# Converts centrelines to every kind of file and back: what comes back is what was given. A wrong file is refused by line and value.
# usage: convert_example.sh <the program> <scratch folder>
program=$1
out=$2
rm -rf "$out"
mkdir -p "$out" || exit 1
fail() {
  echo "convert_example: $*"
  exit 1
}
cp "$(dirname "$0")/two_curves.csv" "$out/given.csv" || exit 1
kinds="vtk obj inp"
"$program" "$out/given.csv" --output "$out/a.vtp" && "$program" "$out/a.vtp" --report >/dev/null 2>&1 && kinds="$kinds tg3"
for kind in $kinds; do
  "$program" "$out/given.csv" --output "$out/a.$kind" || fail "no $kind"
  "$program" "$out/a.$kind" --radius 0.05 --output "$out/$kind.csv" || fail "$kind is not read again"
  cut -d, -f1-5 "$out/given.csv" > "$out/one"
  cut -d, -f1-5 "$out/$kind.csv" > "$out/two"
  cmp -s "$out/one" "$out/two" || fail "$kind comes back otherwise"
done
"$program" "$out/given.csv" --output "$out/a.glb" --output "$out/a.stl" --output "$out/a.bcc" --voxels 0.05 --output "$out/a.vti" --output "$out/a.raw" --report > "$out/report" ||
  fail "surfaces and voxels"
for file in a.glb a.stl a.bcc a.vti a.raw a.raw.json; do
  [ -s "$out/$file" ] || fail "there is no $file"
done
"$program" "$out/given.csv" --voxels 0.05 --box -0.2 -1.2 -0.2 1.2 1.2 0.3 --output "$out/b.vti" --output "$out/b.voxels.inp" \
  --output "$out/b.voxels.csv" --output "$out/b.map.csv" --output "$out/b.map.svg" --output "$out/b.profile.csv" --map y \
  --output "$out/b.yarns.stl" --output "$out/b.yarns.vtp" --output "$out/b.yarns.csv" || fail "what is made of voxels and yarns"
[ "$(wc -l < "$out/b.voxels.csv")" -eq 13441 ] || fail "the table of voxels has not a row for each of 28 x 48 x 10 cells"
# Readers that are not ours, where they are installed.
if python3 -c "import meshio" 2>/dev/null; then
  python3 - "$out" <<'END' || fail "meshio reads otherwise"
import sys
import meshio
import numpy
mesh = meshio.read(sys.argv[1] + "/b.voxels.inp")
(cells,) = mesh.cells
assert cells.type == "hexahedron" and len(cells.data) == 28 * 48 * 10
p = mesh.points[cells.data]
edges = [p[:, k] - p[:, 0] for k in (1, 3, 4)]
assert numpy.allclose(numpy.einsum("ij,ij->i", numpy.cross(edges[0], edges[1]), edges[2]), 0.05**3)
assert {"MATRIX", "YARN_0", "YARN_1"} <= set(mesh.cell_sets) and {"X_LOW", "Z_HIGH"} <= set(mesh.point_sets)
assert sum(len(part) for name in ("MATRIX", "YARN_0", "YARN_1") for part in mesh.cell_sets[name]) == len(cells.data)
surface = meshio.read(sys.argv[1] + "/b.yarns.stl")
t = surface.cells_dict["triangle"]
p = surface.points
volume = numpy.einsum("ij,ij->i", p[t[:, 0]], numpy.cross(p[t[:, 1]], p[t[:, 2]])).sum() / 6
assert abs(volume / (numpy.pi * 0.05**2 * (1.1060 + 2.1003)) - 1) < 0.01, volume  # chords of the two lines
END
fi
grep -q '"curves": 2' "$out/report" || fail "the report does not count the curves"
printf 'fibre,x,y,z\n0,0,0,0\n0,1,oops,0\n' > "$out/wrong.csv"
text=$("$program" "$out/wrong.csv" --output "$out/b.vtk" 2>&1)
[ $? -eq 2 ] || fail "a wrong file was not refused"
case $text in
  *"wrong.csv:3: y = oops"*) ;;
  *) fail "the refusal does not name line and value: $text" ;;
esac
# Options that cannot be, by their own names.
for option in "--scale=0" "--scale=nan" "--metre=-1" "--largest-turn=200" "--voxels=0" "--voxels=1e-9" "--radius=inf"; do
  other=--voxels=0.05
  [ "${option#--voxels}" = "$option" ] || other=--report
  text=$("$program" "$out/given.csv" --output "$out/c.vti" "$other" "$option" 2>&1)
  [ $? -eq 2 ] || fail "$option was not refused"
  case $text in
    *"${option%%=*} = ${option#*=}, but it must be"* | *"${option%%=*} = 1e-09, but it must be larger"*) ;;
    *) fail "the refusal of $option does not name it: $text" ;;
  esac
  [ ! -e "$out/c.vti" ] || fail "$option left a file"
done
exit 0
