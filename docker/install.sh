#!/usr/bin/env bash
# Installs what docker/apt-packages.txt names and is missing; with --tests also what stands below its line "# tests".
# As root, or with sudo. Quick when nothing is missing.
set -euo pipefail
cd "$(dirname "$0")"

wanted='/^# tests/,$d'
[ "${1:-}" = "--tests" ] && wanted=
missing=()
for package in $(sed -e "$wanted" -e 's/#.*//' apt-packages.txt); do
  # Node and npm may have come another way (Debian's npm conflicts with other builds of Node): the commands count.
  case "$package" in
    nodejs) command -v node >/dev/null && continue ;;
    npm) command -v npm >/dev/null && continue ;;
  esac
  dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Missing packages: ${missing[*]}. Run this as root, or install sudo." >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
