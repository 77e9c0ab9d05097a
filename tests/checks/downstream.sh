#!/bin/sh
# SPDX-License-Identifier: MIT
# A small program outside the source tree is built against fibrant and run.
# usage: downstream.sh install|subdirectory SOURCE BUILD COMPILER THREADS
#   install       installs BUILD to a prefix of its own; the program finds the package there
#   subdirectory  the program adds SOURCE through FetchContent
#   THREADS       2, or 1 to leave OpenMP out
set -eu
way=$1 source=$2 build=$3 compiler=$4 threads=$5
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cp -R "$source/tests/checks/downstream" "$place/project"
case $way in
  install)
    cmake --install "$build" --prefix "$place/prefix" > "$place/install.log" || { cat "$place/install.log"; exit 1; }
    if command -v pkg-config > /dev/null; then  # the other way to find what was installed
      flags=$(PKG_CONFIG_PATH="$place/prefix/share/pkgconfig" pkg-config --cflags-only-I fibrant) || { echo "no fibrant.pc"; exit 1; }
      folder=${flags%% *}
      [ -f "${folder#-I}/fibrant/fibrant.hpp" ] || { echo "fibrant.pc says $flags, where there is no fibrant/fibrant.hpp"; exit 1; }
    fi
    set -- -DCMAKE_PREFIX_PATH="$place/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
    ;;
  subdirectory)
    set -- -DFIBRANT_SOURCE="$source"
    ;;
  *)
    echo "unknown way: $way"
    exit 1
    ;;
esac
[ "$threads" -gt 1 ] || set -- "$@" -DFIBRANT_OPENMP=OFF
cmake -S "$place/project" -B "$place/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" "$@"
cmake --build "$place/build"
if [ "$way" = install ]; then  # nothing of the source tree is used
  ! grep -rqF "$source/include" "$place/build/build.ninja" "$place/prefix"
fi
OMP_NUM_THREADS=2 "$place/build/downstream" | tee "$place/said"
grep -q " $threads threads:.* 6144$" "$place/said"
