# SPDX-License-Identifier: MIT
# What convert has to refuse: files that are none, cut short or of numbers that are none, and options that cannot be. Read by
# malformed.sh.
good=$out/good.csv
cp "$here/../two_curves.csv" "$good" || exit 1
# It writes files and no folder: "results" is one, and must not come to be.
# option WORDS ARGUMENT...: with a good file.
option() {
  words=$1
  shift
  try "$words" "$good" "$@"
}
# file NAME WORDS: a file in $out.
file() {
  try "$2" "$out/$1" --output "$out/results.csv"
  try "$2" "$out/$1" --report
}
sed 's/,0.05,/,/; s/,radius//' "$good" > "$out/bare.csv"
kinds="csv vtk obj inp bcc"
mkdir -p "$out/kinds of files"
"$program" "$good" --output "$out/kinds of files/a.vtp" 2> /dev/null && "$program" "$out/kinds of files/a.vtp" --report > /dev/null 2>&1 && kinds="$kinds vtp tg3"
for ending in $kinds; do
  "$program" "$good" --output "$out/kinds of files/a.$ending" || report "cannot write .$ending" "" "$good"
done

of files
for ending in toml png "" csvx stl glb vti raw; do
  cp "$good" "$out/a.$ending"
  try "ends in .$ending, but it must end in .csv" "$out/a.$ending" --output "$out/results.csv"
done
for ending in $kinds; do
  whole="$out/kinds of files/a.$ending"
  : > "$out/empty.$ending"
  file "empty.$ending" "empty.$ending"
  mkdir -p "$out/folder.$ending"
  file "folder.$ending" "folder.$ending: is no file that can be read"
  file "missing.$ending" "missing.$ending: is no file that can be read"
  printf '\n\n' > "$out/blank.$ending"
  file "blank.$ending" "blank.$ending"
  head -c 3000 "$program" > "$out/binary.$ending"
  file "binary.$ending" "binary.$ending"
  head -c 300000 /dev/zero > "$out/zeros.$ending"
  file "zeros.$ending" "zeros.$ending"
  # A table may end after any row, with fewer points; other kinds say how much is to come.
  size=$(wc -c < "$whole")
  for part in 1 3 5 7 9; do
    head -c $((size * part / 10)) "$whole" > "$out/cut.$ending"
    "$program" "$out/cut.$ending" --report > /dev/null 2>&1 && continue
    file "cut.$ending" "cut.$ending"
  done
  if [ "$(id -u)" -ne 0 ]; then
    cp "$whole" "$out/closed.$ending" && chmod 000 "$out/closed.$ending"
    file "closed.$ending" "closed.$ending"
  fi
  # One kind under the name of another.
  for as in $kinds; do
    [ "$as" != "$ending" ] || continue
    cp "$whole" "$out/a_$ending.$as"
    file "a_$ending.$as" "a_$ending.$as"
  done
done

of numbers
for value in nan inf -inf oops 0,5 1e400 "" "0.1 0.2" 0x1 true; do
  for column in 2 3 4; do
    awk -F, -v OFS=, -v k=$column -v value="$value" 'NR == 4 { $k = value } { print }' "$good" > "$out/number.csv"
    file number.csv "number.csv:4: "
  done
  awk -F, -v OFS=, -v value="$value" 'NR > 1 { $5 = value } { print }' "$good" > "$out/number.csv"
  file number.csv "number.csv:2: "
  case $value in
    "" | *" "*) continue ;;  # blanks part numbers in these
  esac
  sed "0,/0\\.1[0-9]*/s//$value/" "$out/kinds of files/a.vtk" > "$out/number.vtk"
  file number.vtk "number.vtk"
  sed "0,/0\\.1[0-9]*/s//$value/" "$out/kinds of files/a.obj" > "$out/number.obj"
  file number.obj "number.obj"
  sed "0,/0\\.1[0-9]*/s//$value/" "$out/kinds of files/a.inp" > "$out/number.inp"
  file number.inp "number.inp"
done
for value in 0 -1 -0.05; do
  awk -F, -v OFS=, -v value="$value" 'NR > 1 { $5 = value } { print }' "$good" > "$out/number.csv"
  file number.csv "number.csv:2: radius = $value, but it must be > 0"
done
for value in 0.5 nan 99999999999999999999 x; do
  awk -F, -v OFS=, -v value="$value" 'NR > 1 { $6 = value } { print }' "$good" > "$out/number.csv"
  file number.csv "number.csv:2: yarn = $value, but it must be a whole number"
  awk -F, -v OFS=, -v value="$value" 'NR > 1 { $7 = value } { print }' "$good" > "$out/number.csv"
  file number.csv "number.csv:2: closed = $value, but it must be a whole number"
done
printf 'fibre,x,y\n0,1,2\n' > "$out/number.csv"
file number.csv "number.csv:1: has no column z"
printf 'fibre,x,y,z\n0,1,2\n' > "$out/number.csv"
file number.csv "number.csv:2: 3 values, but it must be 4"
printf 'fibre,x,y,z\n0,1,2,3\n' > "$out/number.csv"
file number.csv "number.csv:curve 0 '0': 1 points that differ, but it must have at least"
printf 'fibre,x,y,z\n0,0,0,0\n0,1,0,0\n0,0,0.1,0\n0,1,0.1,0\n' > "$out/number.csv"
file number.csv "chords turn by"

of options
try "input is required" --report
try "--output = not given, but it must be given, or --report" "$good"
option "--no-such-option" --report --no-such-option
option "--report has a value, but it must have none" --report=3
option "--output has too few values, but it must have 1" --output
option "--box has 5 values, but it must have at least 6" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1
option "--scale has 2 values, but it must have at most 1" --report --scale 1 --scale 2
for ending in toml png "" stll yarns.csvx voxels.stl map.inp profile.svg; do
  option "--output = $out/results.$ending, but it must be a name that ends in one of .csv" --output "$out/results.csv" --output "$out/results.$ending"
done
option "--output = $good, but it must be another file than the input" --output "$good"
option "cannot write" --output "$out/no such folder/a.csv"
option "cannot write" --output "$out/file/a.csv"
mkdir -p "$out/is_a_folder.csv"
option "cannot write" --output "$out/is_a_folder.csv"
for value in nan inf -inf text true 0,5 1e400 0 -1 "0.1 0.2" ""; do
  for name_of in --scale --metre --radius --voxels --stations --largest-turn; do
    option "$name_of" --output "$out/results.vti" --voxels 0.05 --output "$out/results.yarns.csv" "$name_of=$value"
  done
done
option "--largest-turn = 181, but it must be > 0 and <= 180" --report --largest-turn 181
for value in 1e-09 1e-29 1e-300; do
  option "--voxels = $value, but it must be " --output "$out/results.vti" --voxels $value
  option "--stations = $value, but it must be " --output "$out/results.yarns.csv" --stations $value
done
for value in 1e300 1e-300; do
  option "--scale = " --output "$out/results.vti" --voxels 0.05 --scale $value
  option "--radius = " --output "$out/results.vti" --voxels 0.05 --radius $value
  option "--metre = " --output "$out/results.glb" --metre $value
done
option "--voxels = not given, but it must be given" --output "$out/results.vti"
option "--map" --report --map w
option "--box" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1
option "--box" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1 nan
option "--box" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1 inf
option "--box" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1 text
option "--box: edge along z over the spacing = 20.2, but it must be a whole number" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 1 1.01
option "--box: edge along x over the spacing = -20, but it must be a whole number" --output "$out/results.vti" --voxels 0.05 --box 1 0 0 0 1 1
option "--box: edge along y over the spacing = 0, but it must be a whole number" --output "$out/results.vti" --voxels 0.05 --box 0 0 0 1 0 1
option "--voxels = 0.0001, but it must be larger" --output "$out/results.vti" --voxels 0.0001 --box 0 0 0 1 1 1
try "radius of curve 0 = not given, but it must be in the file, or --radius" "$out/bare.csv" --output "$out/results.stl"

of memory
if [ "$step" -eq 1 ]; then
  message=$(ulimit -v 60000 && exec timeout -s KILL 20 "$program" "$good" --voxels 0.005 --output "$out/results.vti" 2>&1 < /dev/null)
  status=$?
  tried=$((tried + 1))
  case $status:$message in
    2:*"not enough memory"*"--voxels"*) echo "memory 1" >> "$out/kinds" ;;
    *)
      report "ended with status $status within 60 MB" "$message" "$good"
      echo "memory 0" >> "$out/kinds"
      ;;
  esac
  printf '%s\n' "$message" >> "$out/messages"
fi
# Nothing was written for any of them.
for left in "$out"/results*; do
  [ ! -e "$left" ] || report "left a file" "" "$left"
done
