#!/usr/bin/env bash
# Builds the program for a Cortex-M4 (thumbv7em-none-eabihf), runs it in an emulator and compares its hash with that of
# x86_64 Linux. That target's core library is built from source, with the compiler that Debian builds for it:
# packages rustc-web, cargo-web, rust-web-src, qemu-system-arm. Where they are missing it prints SKIPPED.
set -euo pipefail
cd "$(dirname "$0")"

skip() {
  echo "SKIPPED: $1"
  exit 0
}

target=thumbv7em-none-eabihf
debian_cargo=/usr/bin/cargo
debian_rustc=/usr/bin/rustc
[ "$(uname -sm)" = "Linux x86_64" ] || skip "not x86_64 Linux"
command -v cargo > /dev/null || skip "no cargo"
command -v qemu-system-arm > /dev/null || skip "no qemu-system-arm"
[ -x "$debian_cargo" ] && [ -x "$debian_rustc" ] || skip "no cargo-web and rustc-web"
[ -f "$("$debian_rustc" --print sysroot)/lib/rustlib/src/rust/library/core/Cargo.toml" ] || skip "no rust-web-src"
# the linker that comes with every toolchain, or the system's
lld="$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld"
[ -x "$lld" ] || lld=$(command -v ld.lld) || skip "no lld"

folder=${CARGO_TARGET_DIR:-$(cd ../.. && pwd)/target}/bare
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_TARGET CARGO_TARGET_DIR

cargo build --release --locked --target-dir "$folder/host"
here=$("$folder/host/release/taut-bare")

env -u RUSTUP_TOOLCHAIN RUSTC="$debian_rustc" RUSTC_BOOTSTRAP=1 CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER="$lld" \
  "$debian_cargo" build --release --locked -Zbuild-std=core --target "$target" --target-dir "$folder/$target"
# the emulator shows what the program writes on standard error
there=$(timeout 120 qemu-system-arm -M mps2-an386 -nographic -semihosting-config enable=on,target=native \
  -kernel "$folder/$target/$target/release/taut-bare" 2>&1 < /dev/null)

echo "x86_64 $here"
echo "$target $there"
[ "${#here}" = 16 ] && [ "$here" = "$there" ] || {
  echo "the hashes differ"
  exit 1
}
