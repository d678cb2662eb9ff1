#!/usr/bin/env bash
# Installs what is missing, builds, and serves the simulated museum on http://localhost:8080.
#   ./run.sh --build-only     stop after building
#   ./run.sh -- ARGS          hand ARGS to `docent serve`
set -euo pipefail
cd "$(dirname "$0")"
build_only=false
case "${1:-}" in
  --build-only) build_only=true; shift ;;
  --) shift ;;
  "") ;;
  *) echo "usage: ./run.sh [--build-only] [-- ARGUMENTS OF docent serve]" >&2; exit 2 ;;
esac
docker/install.sh
docker/build.sh release
"$build_only" && exit 0
exec build/release/docent serve "$@"
