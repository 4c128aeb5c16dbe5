#!/usr/bin/env bash
# Bytes of text of C programs by the widest vectors that the library was built with: one that takes every function of the
# header, and examples/c/drape.c. Linked statically with what nothing leads to dropped. The bits must be the same in all of them.
#
#     tests/sizes.sh [--target-dir DIR]
set -euo pipefail
cd "$(dirname "$0")/.."
[ "${1:-}" != --target-dir ] || export CARGO_TARGET_DIR=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
{
  echo '#include "taut.h"'
  echo 'typedef void (*function)(void);'
  echo 'function volatile all[] = {'
  grep -o '\btaut_[a-z0-9_]*(' include/taut.h | tr -d '(' | sort -u | sed 's/.*/  (function)&,/'
  echo '};'
  echo 'int main(void) { return all[0] == 0; }'
} > "$folder/all.c"
hash=""
printf '%-8s %14s %14s\n' vectors every_function drape.c
for features in "" avx2 avx2,avx512; do
  cargo build --release --locked --quiet -p taut-ffi --no-default-features --features "$features"
  texts=()
  for program in "$folder/all.c" examples/c/drape.c; do
    cc -std=c11 -O2 -ffunction-sections -fdata-sections -Wl,--gc-sections -I include "$program" \
      "${CARGO_TARGET_DIR:-target}/release/libtaut.a" -lm -o "$folder/program"
    texts+=("$(size "$folder/program" | awk 'NR == 2 { print $1 }')")
  done
  found=$("$folder/program" examples/data/denim.tautfield | sed -n 's/^state hash //p')
  [ -n "$found" ] && [ "${hash:=$found}" = "$found" ] || { echo "tests/sizes.sh: other bits" >&2; exit 1; }
  widest=${features##*,}
  printf '%-8s %14d %14d\n' "${widest:-sse2}" "${texts[@]}"
done
