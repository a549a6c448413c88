#!/usr/bin/env bash
# All tests of a label, one after the other, inside the guest.  tests.sh BUILD LABEL
# A line "figure: ..." that a test prints is shown here also when all is well.
set -uo pipefail
ctest --test-dir "$1" -L "^$2\$" --no-tests=error --output-on-failure
status=$?
sed -n 's/^figure: /  /p' "$1/Testing/Temporary/LastTest.log"
exit $((status != 0))
