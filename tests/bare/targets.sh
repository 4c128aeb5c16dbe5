#!/usr/bin/env bash
# The same bits on every target: builds the program for each, runs it (all but x86_64 in an emulator) and compares what it
# prints: the hashes of every scene. The core library of the other targets is built from source by the compiler that Debian
# builds for that. Debian's packages: rustc-web cargo-web rust-web-src qemu-user qemu-system-arm nodejs.
# What is missing is named and the script fails; nothing is left out in silence.
set -euo pipefail
cd "$(dirname "$0")"

missing=()
need() { # what it is, the package, a test that succeeds where it is there...
  local what=$1 package=$2
  shift 2
  "$@" > /dev/null 2>&1 || missing+=("$what ($package)")
}
debian_cargo=/usr/bin/cargo
debian_rustc=/usr/bin/rustc
core_source() { [ -f "$("$debian_rustc" --print sysroot)/lib/rustlib/src/rust/library/core/Cargo.toml" ]; }
need "$debian_rustc" rustc-web test -x "$debian_rustc"
need "$debian_cargo" cargo-web test -x "$debian_cargo"
need "the source of core" rust-web-src core_source
need qemu-aarch64 qemu-user command -v qemu-aarch64
need qemu-system-arm qemu-system-arm command -v qemu-system-arm
need node nodejs command -v node
# the linker that comes with every toolchain, or the system's
lld="$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld"
[ -x "$lld" ] || lld=$(command -v rust-lld || true)
need rust-lld "the Rust toolchain" test -x "$lld"
if [ ${#missing[@]} -gt 0 ]; then
  printf 'missing: %s\n' "${missing[@]}"
  exit 1
fi

folder=${CARGO_TARGET_DIR:-$(cd ../.. && pwd)/target}/bare
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_TARGET CARGO_TARGET_DIR
targets=(aarch64-unknown-none thumbv7em-none-eabihf wasm32-unknown-unknown i686-unknown-linux-gnu)

cargo build --quiet --release --locked --target-dir "$folder/host"
cargo build --quiet --locked --target-dir "$folder/host"
env -u RUSTUP_TOOLCHAIN RUSTC="$debian_rustc" RUSTC_BOOTSTRAP=1 \
  CARGO_TARGET_AARCH64_UNKNOWN_NONE_LINKER="$lld" CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER="$lld" \
  CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER="$lld" CARGO_TARGET_I686_UNKNOWN_LINUX_GNU_LINKER="$lld" \
  CARGO_TARGET_I686_UNKNOWN_LINUX_GNU_RUSTFLAGS="-Clinker-flavor=ld.lld -Crelocation-model=static" \
  "$debian_cargo" build --release --locked -Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem \
  "${targets[@]/#/--target=}" --target-dir "$folder/cross"

# the kernel runs it, or where it was built without 32-bit programs the emulator
run_i686=(env)
"$folder/cross/i686-unknown-linux-gnu/release/taut-bare" > /dev/null 2>&1 || [ $? -lt 126 ] || run_i686=(qemu-i386)
program() { echo "$folder/cross/$1/release/taut-bare"; }
here=$("$folder/host/release/taut-bare")
short=$(grep -v ' 10000 ' <<< "$here")
passed=0 failed=0
compare() { # name, what it must print, command...
  local name=$1 expected=$2 start=$SECONDS printed status=0
  shift 2
  printed=$("$@" 2>&1 < /dev/null) || status=$?
  if [ "$status" = 0 ] && [ "$printed" = "$expected" ]; then
    printf 'same bits  %s, %d s\n' "$name" $((SECONDS - start))
    passed=$((passed + 1))
  else
    printf 'OTHER BITS %s, exit status %s\n' "$name" "$status"
    diff <(echo "$expected") <(echo "$printed") || true
    failed=$((failed + 1))
  fi
}
echo "$here"
[ "$(grep -c '^[a-z0-9]* *10\?000 [0-9a-f]\{16\}$' <<< "$short")" -ge 8 ] || { echo "the program printed too little"; exit 1; }
compare "x86_64, a debug build" "$short" "$folder/host/debug/taut-bare"
compare "i686 with SSE2" "$short" "${run_i686[@]}" "$(program i686-unknown-linux-gnu)"
compare "aarch64 (qemu-user)" "$short" qemu-aarch64 "$(program aarch64-unknown-none)"
# the emulator shows what the program writes on standard error
compare "thumbv7em, Cortex-M4 (qemu-system-arm)" "$short" timeout 300 qemu-system-arm -M mps2-an386 -nographic \
  -semihosting-config enable=on,target=native -kernel "$(program thumbv7em-none-eabihf)"
compare "wasm32 (node)" "$(sed '/modes/,$d' <<< "$short")" node wasm.mjs "$(program wasm32-unknown-unknown).wasm"
printf '%d passed, %d failed\n' "$passed" "$failed"
[ "$failed" = 0 ]
