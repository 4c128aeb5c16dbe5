#!/usr/bin/env bash
# Instructions per particle and substep, counted by callgrind, against tests/counts.json: clocks are noisy, these are not.
# More than 5 % more is a failure, and so is 5 % less, so that what was won is written down. TAUT_BLESS=1 writes the file anew.
# Callgrind knows no AVX-512. Counted is the profile of the tests, which has overflow checks: it is there already, and what grows there
# grows in a release.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --quiet --locked --workspace --example counts
program=${CARGO_TARGET_DIR:-target}/debug/examples/counts
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# every call of counts_mark ends a part of the profile
valgrind --quiet --tool=callgrind --callgrind-out-file="$out/profile" --combine-dumps=yes --dump-before=counts_mark \
  "$program" > "$out/order"
TAUT_BLESS=${TAUT_BLESS:-} python3 - "$out" tests/counts.json << 'PY'
import json, os, pathlib, sys

out, kept = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TOLERANCE = 0.05
lines = (out / "order").read_text().split("\n")
order = [line.split() for line in lines if line]
skipped = [name for first, name in order if first == "SKIPPED"]
counted = [(name, int(steps)) for name, steps in order if name != "SKIPPED"]
# the file has a summary of each part; before each load comes what was done to make it, and after the last the end
parts = [int(line.split()[1]) for line in (out / "profile").read_text().split("\n") if line.startswith("summary:")]
assert len(parts) == 2 * len(counted) + 1, f"{len(parts)} parts of {len(counted)} loads"
now = {name: round(parts[2 * i + 1] / steps, 2) for i, (name, steps) in enumerate(counted)}
if os.environ["TAUT_BLESS"]:
    kept.write_text(json.dumps(now, indent=2) + "\n")
    print(f"wrote {kept}")
    sys.exit()
before = json.loads(kept.read_text())
bad = 0
for name in skipped:
    print(f"SKIPPED {name}: this machine lacks the width")
for name, count in now.items():
    was = before.get(name)
    change = None if was is None else count / was - 1.0
    off = change is None or abs(change) > TOLERANCE
    bad += off
    told = "not in the file" if was is None else f"was {was:8.2f}, {100.0 * change:+5.1f} %"
    print(f"{name:28} {count:8.2f} instructions a particle-step, {told}{'   <--' if off else ''}")
missing = sorted(set(before) - set(now) - set(skipped))
for name in missing:
    print(f"{name}: in the file, but not counted   <--")
if bad or missing:
    sys.exit(f"{bad + len(missing)} counts are off by more than {100 * TOLERANCE:.0f} %: TAUT_BLESS=1 tests/counts.sh writes them down")
PY
