#!/usr/bin/env bash
# Coverage-guided fuzzing on the stock toolchain: run.sh SECONDS [TARGET...]. Each target starts from its committed corpus and
# runs so many seconds, two at a time. A finding is written to target/fuzz/findings and fails the script.
# RUSTC_BOOTSTRAP=1 is for -Zsanitizer=address alone; the coverage is a pass of LLVM that the stable compiler has.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:-30}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(definitions field_file snapshot calls parts metadata)

folder=${CARGO_TARGET_DIR:-$(cd .. && pwd)/target}/fuzz
unset CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_TARGET CARGO_TARGET_DIR
host=x86_64-unknown-linux-gnu
flags=(-Zsanitizer=address -Cpasses=sancov-module -Ccodegen-units=1
  -Cllvm-args=-sanitizer-coverage-level=4 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters
  -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares)
# libFuzzer as Debian ships it (libclang-rt-14-dev); where it is not there the crate compiles its own, in a minute or two
custom=(/usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-x86_64.a)
[ ! -f "${custom[0]}" ] || export CUSTOM_LIBFUZZER_PATH=${custom[0]}
RUSTC_BOOTSTRAP=1 RUSTFLAGS="${flags[*]}" \
  cargo build --release --locked --target "$host" --target-dir "$folder"

mkdir -p "$folder/findings"
fuzz() { # target
  # what is found on the way stays out of the committed corpus
  mkdir -p "$folder/corpus/$1"
  "$folder/$host/release/$1" "$folder/corpus/$1" "corpus/$1" -max_total_time="$seconds" -max_len=2048 -timeout=20 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$folder/findings/$1-" > "$folder/$1.log" 2>&1
}
passed=0 failed=0
for ((i = 0; i < ${#targets[@]}; i += 2)); do
  pids=() names=("${targets[@]:i:2}")
  for name in "${names[@]}"; do
    fuzz "$name" &
    pids+=($!)
  done
  for j in "${!names[@]}"; do
    name=${names[j]}
    if wait "${pids[j]}"; then
      passed=$((passed + 1))
      printf '%-12s no finding; %s\n' "$name" "$(grep -E '^#[0-9]+[[:space:]]+DONE' "$folder/$name.log")"
    else
      failed=$((failed + 1))
      printf '%-12s FINDING\n' "$name"
      tail -n 40 "$folder/$name.log"
    fi
  done
done
printf '%d passed, %d failed\n' "$passed" "$failed"
[ "$failed" = 0 ]
