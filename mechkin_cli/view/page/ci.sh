#!/usr/bin/env bash
# Brings what the page's tests need (a browser, Node, the pinned packages) and compares the built page byte by byte;
# `ci.sh kernel` builds the kernel in the page again and compares its bytes.
# As root with apt it installs what is missing; elsewhere it says what is, and the browser's tests are skipped.
set -euo pipefail
cd "$(dirname "$0")"

# where its compiler can be had
kernel() {
  local wasm=../../kernel/wasm
  zig=$(mktemp -d)
  trap 'rm -rf "$zig"' EXIT
  if python3 -m pip install -q --target "$zig" "ziglang==$(sed -n 's/.*"ziglang": "\(.*\)".*/\1/p' "$wasm/lock.json")"; then
    PYTHONPATH="$zig" python3 "$wasm/build.py" --check
  else
    echo "the kernel in the page is not built again: no ziglang here"
  fi
}

missing() {
  local each
  for each in node npm chromium; do command -v "$each" > /dev/null || printf '%s ' "$each"; done
}

if [ "${1:-}" = kernel ]; then
  kernel
  exit
fi
if [ -n "$(missing)" ] && [ "$(id -u)" = 0 ] && command -v apt-get > /dev/null; then
  packages=$(missing)
  apt-get update -qq
  # shellcheck disable=SC2086 # one package a word
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends ${packages/node /nodejs } > /dev/null
fi
if [ -n "$(missing)" ]; then
  echo "the page of \`mechkin view\` is neither rebuilt nor tried in a browser: not here: $(missing)"
  exit 0
fi
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
npm run --silent check

python3 ../../kernel/wasm/build.py --check --quick
