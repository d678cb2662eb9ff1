#!/usr/bin/env bash
# Builds the server (preset $1, default release) and the pages. Used by run.sh, test.sh and the Dockerfile.
# Further arguments are targets; default: the docent program alone.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -gt 0 ] && shift

# The docent program alone needs none of the tests' packages. Once a build has its tests it keeps them.
cache=build/$preset/CMakeCache.txt
if [ $# -gt 0 ]; then
  grep -qs 'DOCENT_TESTS:BOOL=ON' "$cache" || cmake --preset "$preset" -DDOCENT_TESTS=ON >/dev/null
else
  [ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" -DDOCENT_TESTS=OFF >/dev/null
fi
cmake --build --preset "$preset" --target "${@:-docent}"

# The pages: packages only when the lock file changed, bundles only when a source changed.
stamp=web/node_modules/.docent-lock
if ! cmp -s web/package-lock.json "$stamp"; then
  # Not `npm ci`: the lock file may lack packages for other kinds of machine, which npm ci refuses.
  npm --prefix web install --no-save --no-audit --no-fund --loglevel=error
  cp web/package-lock.json "$stamp"
fi
if [ ! -f web/dist/index.html ] || [ -n "$(find web static/fonts static/icons protocols/web -newer web/dist/index.html -type f \
    -not -path '*/node_modules/*' -not -path 'web/dist/*' -print -quit 2>/dev/null)" ]; then
  npm --prefix web run --silent build
fi
