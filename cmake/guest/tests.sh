#!/usr/bin/env bash
# All tests of label guest, one after the other, inside it.  tests.sh BUILD
# A line "figure: ..." that a test prints is shown here also when all is well.
set -uo pipefail
ctest --test-dir "$1" -L '^guest$' --no-tests=error --output-on-failure
status=$?
sed -n 's/^figure: /  /p' "$1/Testing/Temporary/LastTest.log"
exit $((status != 0))
