#!/usr/bin/env bash
# clang-tidy over every source of ours; a file is looked at again only when it, its headers or the rules changed.
set -euo pipefail
cd "$(dirname "$0")/.."
cache=build/tidy
mkdir -p "$cache"
rules=$(cat $(git ls-files '*.clang-tidy' '*.hpp') | sha256sum | cut -c1-16)
check() {
  source=$1
  stamp="$cache/$(printf '%s %s' "$2" "$(sha256sum <"$source")" | sha256sum | cut -c1-32)"
  [ -f "$stamp" ] && exit 0
  clang-tidy --quiet -p build/release "$source" 2>/dev/null && touch "$stamp"
}
export -f check
export cache
git ls-files 'robot/*.cpp' 'protocols/*.cpp' 'server/*.cpp' | xargs -P "$(nproc)" -I{} bash -c 'check {} '"$rules"
