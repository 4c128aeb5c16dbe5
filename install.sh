#!/usr/bin/env bash
# Builds the C library and installs it for C and C++: headers, static and shared library, CMake package, pkg-config file.
#
#     ./install.sh --prefix DIR [--target-dir DIR] [--vectors sse2|avx2|avx512]
#
# --vectors names the widest vectors of x86_64 that are built in (default avx512): a narrower library is smaller, with the
# same bits. DESTDIR, if set, is put before the prefix. The installed tree may be moved as a whole. For Linux and macOS.
set -euo pipefail
cd "$(dirname "$0")"

usage() {
  sed -n '2,7s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

prefix="" build=target/package vectors=avx512
while [ $# -gt 0 ]; do
  case $1 in
    --prefix) [ $# -ge 2 ] || usage; prefix=$2; shift 2 ;;
    --prefix=*) prefix=${1#*=}; shift ;;
    --target-dir) [ $# -ge 2 ] || usage; build=$2; shift 2 ;;
    --target-dir=*) build=${1#*=}; shift ;;
    --vectors) [ $# -ge 2 ] || usage; vectors=$2; shift 2 ;;
    --vectors=*) vectors=${1#*=}; shift ;;
    *) usage ;;
  esac
done
case $vectors in
  sse2) features="" ;;
  avx2) features=avx2 ;;
  avx512) features=avx2,avx512 ;;
  *) usage ;;
esac
[ -n "$prefix" ] || usage

number() { sed -n "s/^#define TAUT_VERSION_$1 \([0-9]*\)\$/\1/p" include/taut.h; }
major=$(number MAJOR) minor=$(number MINOR) patch=$(number PATCH)
version=$major.$minor.$patch
# What a program that was linked with this library asks for at run time. It changes when programs may break.
abi=$major
[ "$major" -gt 0 ] || abi=$major.$minor

case $(uname -s) in
  Linux)
    shared_built=libtaut.so shared_link=libtaut.so shared_name=libtaut.so.$abi shared_file=libtaut.so.$version
    link=-Wl,-soname,$shared_name
    ;;
  Darwin)
    shared_built=libtaut.dylib shared_link=libtaut.dylib
    shared_name=libtaut.$abi.dylib shared_file=libtaut.$version.dylib
    link=-Wl,-install_name,@rpath/$shared_name
    ;;
  *)
    echo "install.sh is for Linux and macOS; on Windows link target/release/taut.lib of 'cargo build --release -p taut-ffi'" >&2
    exit 1
    ;;
esac

# The same library as that of `cargo build --release -p taut-ffi`, in a folder of its own since the name within differs.
cargo rustc --release --locked -p taut-ffi --lib --no-default-features --features "$features" --target-dir "$build" -- \
  -C link-arg="$link" -C strip=symbols
pointer_bytes=$(getconf LONG_BIT | awk '{ print $1 / 8 }')

root=${DESTDIR:-}$prefix
lib=$root/lib
mkdir -p "$root/include" "$lib/cmake/taut" "$lib/pkgconfig" "$root/share/doc/taut"
install -m 644 include/taut.h include/taut.hpp include/taut_generator.h "$root/include"
install -m 644 "$build/release/libtaut.a" "$lib"
strip -S "$lib/libtaut.a" # debugging information of Rust's own library, most of the file
install -m 755 "$build/release/$shared_built" "$lib/$shared_file"
ln -sf "$shared_file" "$lib/$shared_name"
ln -sf "$shared_name" "$lib/$shared_link"
install -m 644 docs/c-api.md LICENSE-MIT LICENSE-APACHE "$root/share/doc/taut"

fill() { # template, file
  sed -e "s/@VERSION@/$version/g" -e "s/@MAJOR@/$major/g" -e "s/@MINOR@/$minor/g" \
    -e "s/@SHARED_FILE@/$shared_file/g" -e "s/@SHARED_NAME@/$shared_name/g" \
    -e "s/@POINTER_BYTES@/$pointer_bytes/g" "packaging/$1" > "$2"
}
fill tautConfig.cmake.in "$lib/cmake/taut/tautConfig.cmake"
fill tautConfigVersion.cmake.in "$lib/cmake/taut/tautConfigVersion.cmake"
fill taut.pc.in "$lib/pkgconfig/taut.pc"
echo "taut $version is in $root"
