#!/usr/bin/env bash
# Runs a script of label guest; outside the guest it fails, as guest_main.cpp does.  inside.sh SCRIPT ARGUMENTS...
set -euo pipefail
if [[ ! -e /run/whirl_guest/report/started ]]; then
  echo "this test runs inside the guest only: ./whirl test --guest" >&2
  exit 1
fi
exec "$@"
