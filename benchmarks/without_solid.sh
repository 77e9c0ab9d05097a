#!/bin/sh
# SPDX-License-Identifier: MIT
# What does a model of fibres alone pay for solids? Compiles the increments of such a model twice, with the headers as they are
# and with a copy from which all that deals with solids has been cut out, and compares the object code function by function.
# usage: without_solid.sh INCLUDE_FOLDER [COMPILER]; prints sizes, counts, and the functions that differ
set -eu
include=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
compiler=${2:-c++}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cp -r "$include" "$folder/without"
sh "$here/cut_solid.sh" "$folder/without"
cd "$folder"

cat > "$folder/model.cpp" <<'CPP'
#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/nested_loops.hpp>
using namespace fibrant;
using Beam = beam::DirectorBeam<3>;
using Contacts = contact::ContactSet<Beam, proximity::BruteSearch, law::RegularisedPenalty, law::RegularisedCoulomb>;
using Equilibrium = assembly::Equilibrium<Beam, Contacts>;
template class assembly::Equilibrium<Beam, Contacts>;
template class solver::NestedLoops<Equilibrium, Contacts, solver::FibreBlockPcg>;
template <std::size_t contact_element, std::size_t contact_point, std::size_t contact_set, std::size_t equilibrium>
void sizes_in_bytes() {}
template void sizes_in_bytes<sizeof(Contacts::Element), sizeof(Equilibrium::System::Point), sizeof(Contacts), sizeof(Equilibrium)>();
CPP

for kind in with without; do
  [ $kind = with ] && headers=$include || headers=$folder/without
  "$compiler" -std=c++20 -O2 -DNDEBUG -fopenmp -w -S -I"$headers" -isystem /usr/include/eigen3 "$folder/model.cpp" -o - | c++filt |
    sed -e 's/, fibrant::solid::NoSolid//g' | awk '
    /^\t\.type\t.*@function$/ { inside = 1; count = lines = 0; split("", number); body = ""; name = $0; sub(/^\t\.type\t/, "", name); sub(/, @function$/, "", name); next }
    /^\t\.size\t/ && inside { print name "\t" lines "\t" body; inside = 0; next }
    !inside || /^\t\.(cfi|loc|p2align|section|globl|weak|hidden|text|align|byte|long|value|uleb128)/ { next }
    /^\.L[A-Z]+[0-9]+:/ && !/^\.L[0-9]/ { next }
    {
      rest = $0; text = ""
      while (match(rest, /\.L[A-Z]*[0-9]+/)) {  # labels by the order in which they come
        label = substr(rest, RSTART, RLENGTH)
        if (!(label in number)) number[label] = ++count
        text = text substr(rest, 1, RSTART - 1) ".L" number[label]; rest = substr(rest, RSTART + RLENGTH)
      }
      text = text rest
      if (text !~ /:$/) ++lines
      gsub(/\t/, " ", text); body = body text ";"
    }' | sort > "$folder/$kind.txt"
done

grep -o '^void sizes_in_bytes<[^>]*>' "$folder/with.txt" | sed -e 's/ul//g' -e 's/^/with:    contact element, point of the tangent, contact set, equilibrium: /'
grep -o '^void sizes_in_bytes<[^>]*>' "$folder/without.txt" | sed -e 's/ul//g' -e 's/^/without: contact element, point of the tangent, contact set, equilibrium: /'
awk -F '\t' '{ n += $2 } END { print FILENAME ": " NR " functions, " n " instructions" }' "$folder/with.txt" | sed 's,.*/,,;s/\.txt//'
awk -F '\t' '{ n += $2 } END { print FILENAME ": " NR " functions, " n " instructions" }' "$folder/without.txt" | sed 's,.*/,,;s/\.txt//'
same=$(comm -12 "$folder/with.txt" "$folder/without.txt" | wc -l)
echo "functions of the same instructions: $same"
comm -23 "$folder/with.txt" "$folder/without.txt" | cut -f 1,2 | cut -c 1-300 | sed 's/^/only with:    /'
comm -13 "$folder/with.txt" "$folder/without.txt" | cut -f 1,2 | cut -c 1-300 | sed 's/^/only without: /'
