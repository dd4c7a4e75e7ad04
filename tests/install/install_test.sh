#!/usr/bin/env bash
# Installs the build into an empty folder and uses it from there, as somebody does who has no checkout:
#   install_test.sh CASE BUILD_FOLDER SOURCE_FOLDER WORK_FOLDER
set -euo pipefail
case=$1 build=$2 source=$3 work=$4
prefix=$work/prefix
fail() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}

build_example() { # folder
  if ! { cmake -S "$1" -B "$1/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" &&
    cmake --build "$1/build"; } >"$1/log" 2>&1; then
    cat "$1/log"
    fail "the example does not build against $prefix"
  fi
}

case $case in
  install)
    rm -rf -- "$work"
    mkdir -p "$work"
    cmake --install "$build" --prefix "$prefix" >"$work/install.log"
    ;;
  cmake_shared | cmake_static)
    rm -rf -- "${work:?}/$case"
    cp -r "$prefix/share/cdem/examples/cpp" "$work/$case"
    if [[ $case == cmake_static ]]; then sed -i 's/PRIVATE cdem::cdem)/PRIVATE cdem::cdem_static)/' "$work/$case/CMakeLists.txt"; fi
    build_example "$work/$case"
    "$work/$case/build/pillar"
    linked=$(ldd "$work/$case/build/pillar")
    if [[ $case == cmake_shared ]]; then
      grep -q "$prefix/.*libcdem.so" <<<"$linked" || fail "the program does not use the installed libcdem: $linked"
    elif grep -q 'libcdem\|libgeom' <<<"$linked"; then
      fail "the program was to have libcdem in itself: $linked"
    fi
    ;;
  pkg_config)
    export PKG_CONFIG_PATH
    PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name cdem.pc)")
    read -ra flags <<<"$(pkg-config --cflags --libs cdem)"
    "${CXX:-c++}" -std=c++17 "$prefix/share/cdem/examples/cpp/pillar.cpp" -o "$work/pillar" "${flags[@]}"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir cdem) "$work/pillar"
    [[ $(pkg-config --modversion cdem) == "$("$prefix/bin/cdem" --version | cut -d' ' -f2)" ]] ||
      fail "pkg-config and cdem --version differ"
    pkg-config --exists cdem-vtk || fail "no cdem-vtk"
    ;;
  headers) # each stands alone in the installed tree, and none shows a library but Eigen
    cd -- "$prefix/include/cdem"
    find . -name '*.hpp' -printf '#include <%P>\n' | sort >"$work/all.cpp"
    [[ $(wc -l <"$work/all.cpp") -gt 50 ]] || fail "too few headers"
    "${CXX:-c++}" -std=c++17 -fsyntax-only -I. -isystem /usr/include/eigen3 "$work/all.cpp"
    others=$(grep -rhoE '^#include <[^>]*/[^>]*>' . | grep -v '<Eigen/' | sort -u || true)
    [[ -z $others ]] || fail "public headers include $others"
    ;;
  program) # needs nothing of the checkout
    cd /
    if grep -aqF "$source/" "$prefix/bin/cdem"; then fail "the program names files of the source tree"; fi
    env -i PATH=/usr/bin:/bin HOME="$work" "$prefix/bin/cdem" run "$prefix/share/cdem/examples/cohesive_bar/case.lua" \
      --threads 1 --quiet --output "$work/results"
    [[ -s $work/results/report.md ]] || fail "no report.md"
    "$prefix/bin/cdem" annotations | cmp - "$prefix/share/cdem/meta/cdem.lua" || fail "not the program's annotations"
    ;;
  *) fail "no case $case" ;;
esac
