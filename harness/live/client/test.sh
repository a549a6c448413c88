#!/usr/bin/env bash
# test.sh WHIRL PACE BUILD_FOLDER: installs the client's library by its lock file, once, and flies.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$1 pace=$2 client=$3/fly_client
for tool in node npm; do
  command -v "$tool" >/dev/null || { echo "$tool is not there: ./whirl test installs it (nodejs, npm)" >&2; exit 1; }
done
mkdir -p "$client"
exec 8>"$client/.lock"
flock 8
if ! cmp -s "$here/package-lock.json" "$client/node_modules/.lock_of_whirl"; then
  cp "$here/package.json" "$here/package-lock.json" "$client"
  (cd "$client" && npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1) ||
    { cat "$client/npm.log" >&2; echo "npm ci failed: the library is not to be had" >&2; exit 1; }
  cp "$here/package-lock.json" "$client/node_modules/.lock_of_whirl"
fi
cp "$here"/*.mjs "$client"
flock -u 8
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
node "$client/fly.mjs" "$program" "$pace" "$results"
