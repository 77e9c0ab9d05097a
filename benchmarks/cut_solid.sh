#!/bin/sh
# SPDX-License-Identifier: MIT
# Cuts out of a copy of the headers all by which increments of fibres alone deal with solids.
# usage: cut_solid.sh COPY_OF_INCLUDE_FOLDER; fails if a line is left that does
set -eu
cd "$1/fibrant"
sed -i -e 's/, class Solid = solid::NoSolid//' -e 's/typename SystemOf<B, Solid>::Type/ChainSystem<B>/' -e '/bool has_solid/d' \
  -e 's/, const Solid& solid = Solid())/)/' -e 's/ solid_{taken(solid, assembly, mesh, channels)},//' -e 's/system_{system(mesh, solid_)}/system_{mesh}/' \
  -e '/Solid& solid()/d' -e '/static Solid taken(/,/^    }$/d' -e '/static System system(/,/^    }$/d' \
  -e '/if constexpr (has_solid) {$/,/^ *}$/d' -e '/if constexpr (has_solid)/d' -e '/Solid solid_;/d' -e 's/solid_system.hpp/chain_system.hpp/' assembly/equilibrium.hpp
sed -i -e '/^\/\/\/ A model whose fibres are bonded to solids/,/^}  \/\/ namespace detail/d' -e '/SolidOf<M>::Type::Parameters solid/d' -e 's/solid_system.hpp/chain_system.hpp/' \
  -e 's/typename assembly::SystemOf<typename M::Beam, typename detail::SolidOf<M>::Type>::Type/typename assembly::ChainSystem<typename M::Beam>/' simulation/model.hpp
sed -i -e '/using Solid =/d' -e 's/ConnectionsOf<M>::Type, Solid>/ConnectionsOf<M>::Type>/' -e 's/, Solid(parameters.solid)}/}/' -e '/else if (!assembly.solids/d' \
  -e '/double accept_solid() {$/,/^    }$/d' -e '/HasSolid<M>)/d' simulation/simulator.hpp
if grep -nE 'solid_|Solid|NoSolid' assembly/equilibrium.hpp simulation/model.hpp simulation/simulator.hpp | grep -vE '//[/ !]'; then
  echo "these lines still deal with solids"; exit 1
fi
