#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests.
#   ./test.sh --all     also with the sanitizers, and clang-tidy over every source
set -euo pipefail
cd "$(dirname "$0")"
docker/install.sh --tests

echo "== format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror

echo "== build"
docker/build.sh release all

echo "== core, protocols, server"
ctest --preset release -j2

echo "== pages"
npm --prefix web run --silent check
npm --prefix web test --silent
npm --prefix web run --silent test:browser

[ "${1:-}" = "--all" ] || exit 0

echo "== sanitizers"
docker/build.sh asan all
ctest --preset asan -j2 -E 'bench_runs|replay_test'
docker/build.sh tsan docent server_{devices,store,stream,http,api,tools}_test integration_test
ctest --preset tsan -j2 -R 'server_|integration_test'

echo "== lint"
docker/lint.sh
