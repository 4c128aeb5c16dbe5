#!/usr/bin/env bash
# The package that install.sh makes, as its users have it: installed, moved, found by CMake and pkg-config, linked statically
# and dynamically from C and C++ by gcc and clang; the programs all print the same hash.
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
  echo "tests/package.sh: $*" >&2
  exit 1
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
./install.sh --prefix "$folder/first" "$@"
# a package may be moved
mv "$folder/first" "$folder/second place"
prefix="$folder/second place"

number() { sed -n "s/^#define TAUT_VERSION_$1 \([0-9]*\)\$/\1/p" include/taut.h; }
version=$(number MAJOR).$(number MINOR).$(number PATCH)
abi=$(number MAJOR)
[ "$abi" -gt 0 ] || abi=$abi.$(number MINOR)

# the shared library: its name, what it needs, what it gives
shared="$prefix/lib/libtaut.so.$version"
[ -f "$shared" ] || fail "no libtaut.so.$version"
[ "$(readlink -f "$prefix/lib/libtaut.so")" = "$(readlink -f "$shared")" ] || fail "libtaut.so is another library"
dynamic=$(readelf -d "$shared")
grep -q "SONAME.*\[libtaut.so.$abi\]" <<< "$dynamic" || fail "its SONAME is not libtaut.so.$abi"
! grep -q NEEDED <<< "$dynamic" || fail "it needs a library"
[ -e "$prefix/lib/libtaut.so.$abi" ] || fail "no file of the name that programs ask for"
exported=$(nm -D --defined-only "$shared" | awk '{ print $3 }' | sort)
declared=$(grep -o '\btaut_[a-z0-9_]*(' "$prefix/include/taut.h" | tr -d '(' | sort -u)
[ "$exported" = "$declared" ] || fail "exports and header differ: $(diff <(echo "$exported") <(echo "$declared"))"
[ -z "$(nm "$shared" 2> /dev/null)" ] || fail "it is not stripped"

hash=""
same() { # program and arguments: prints the hash of all others
  local found
  found=$("$@" | sed -n 's/^state hash //p')
  [ -n "$found" ] || fail "$1 prints no hash"
  [ "${hash:=$found}" = "$found" ] || fail "$1 prints $found, not $hash"
}
field=$PWD/examples/data/denim.tautfield

# CMake
for compilers in "gcc g++" "clang clang++"; do
  read -r c cxx <<< "$compilers"
  build=$folder/cmake-$c
  cmake -S examples/cmake -B "$build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$c" -DCMAKE_CXX_COMPILER="$cxx" \
    -DCMAKE_C_FLAGS="-Wall -Wextra -pedantic -Werror" -DCMAKE_CXX_FLAGS="-Wall -Wextra -pedantic -Werror" > "$folder/log" \
    && cmake --build "$build" >> "$folder/log" || fail "$(cat "$folder/log")"
  for program in drape_c drape_c_shared drape_cpp drape_cpp_shared; do
    same "$build/$program" "$field"
  done
  readelf -d "$build/drape_c_shared" | grep -q "NEEDED.*libtaut.so.$abi" || fail "drape_c_shared is not dynamic"
  ! readelf -d "$build/drape_c" | grep -q taut || fail "drape_c is not static"
done

# what find_package accepts
mkdir "$folder/ask"
accepts() { # version that is asked for
  printf 'cmake_minimum_required(VERSION 3.16)\nproject(ask C)\nfind_package(taut %s CONFIG QUIET)\n' "$1" \
    > "$folder/ask/CMakeLists.txt"
  printf 'file(WRITE ${CMAKE_BINARY_DIR}/answer "${taut_FOUND}")\n' >> "$folder/ask/CMakeLists.txt"
  rm -rf "$folder/ask/build"
  cmake -S "$folder/ask" -B "$folder/ask/build" -DCMAKE_PREFIX_PATH="$prefix" > /dev/null
  [ "$(cat "$folder/ask/build/answer")" = 1 ]
}
accepts "" || fail "find_package(taut) does not find it"
accepts "$version EXACT" || fail "find_package(taut $version EXACT) does not find it"
for wrong in "$(number MAJOR).$(($(number MINOR) + 1))" "$(($(number MAJOR) + 1)).0" "$version.1" "$version.1 EXACT"; do
  ! accepts "$wrong" || fail "find_package(taut $wrong) is answered with $version"
done

# pkg-config
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
[ "$(pkg-config --modversion taut)" = "$version" ] || fail "pkg-config tells another version"
eval "gcc -std=c11 examples/c/drape.c $(pkg-config --cflags --libs taut) -o $folder/by_pkg_config"
LD_LIBRARY_PATH="$prefix/lib" same "$folder/by_pkg_config" "$field"
! "$folder/by_pkg_config" "$field" > /dev/null 2>&1 || fail "it was linked statically"
eval "g++ -std=c++17 examples/cpp/drape.cpp $(pkg-config --cflags taut) '$prefix/lib/libtaut.a' -o $folder/static"
same "$folder/static" "$field"

echo "the package works: state hash $hash from C and C++, gcc and clang, static and shared, CMake and pkg-config"
