#!/usr/bin/env bash
# The source files of the host build through clang-tidy (.clang-tidy), and what is no test through clang's static
# analyzer too.  lint.sh BUILD [--each | FILE...]; BUILD holds compile_commands.json; exit 1 if anything is found.
# All of them go through many at a time (batches.py), which takes a tenth of the time; named files, and all with
# --each, one by one: only then is it seen that a file does not include what it needs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
shift
cd "$here/../.."
analyzer=clang-analyzer-core.*,clang-analyzer-cplusplus.*,clang-analyzer-deadcode.*,clang-analyzer-unix.*

known=$(sed -n 's/^ *"file": "\(.*\)".*$/\1/p' "$build/compile_commands.json" | sort -u |
  sed -n "s,^$PWD/,,p" | grep -v '^build/')
one_by_one=$#
if (($#)) && [[ $1 != --each ]]; then
  known=$(printf '%s\n' "$@" | grep -xF "$known") || { echo "lint: the build knows none of these files"; exit 1; }
fi

# Quiet, and one after the other: what a file has to say comes in one piece.
check() {
  local said
  said=$(clang-tidy-14 --quiet -p "$1" "$2" "$3" 2>&1) && return 0
  grep -v 'warnings generated' <<<"$said" || true
  return 1
}

# check_batch CHECKS BATCH: files of which the compiler says that they don't go together, go by halves.
check_batch() {
  local said options half failed=0 files
  mapfile -t options <"$2.options"
  said=$(clang-tidy-14 --quiet "$1,-bugprone-suspicious-include" "$2" -- "${options[@]}" 2>&1) && return 0
  files=$(wc -l <"$2")
  if ((files > 1)) && grep -q 'clang-diagnostic-error' <<<"$said"; then
    split -n l/2 --additional-suffix=.cpp "$2" "${2%.cpp}_"
    for half in "${2%.cpp}_"a{a,b}.cpp; do
      cp "$2.options" "$half.options"
      check_batch "$1" "$half" || failed=1
    done
    return "$failed"
  fi
  grep -v 'warnings generated' <<<"$said" || true
  return 1
}
export -f check check_batch

failed=0
# run CHECKS NAME FILES
run() {
  [[ -n $3 ]] || return 0
  if ((one_by_one)); then
    xargs -P "$(nproc)" -I{} bash -c 'check "$@"' - "$build" "--checks=$1" {} <<<"$3" || failed=1
  else
    # shellcheck disable=SC2086  # no name of ours has a space
    python3 "$here/batches.py" "$build" "$build/together/$2" $3 >"$build/together_$2.txt"
    xargs -P "$(nproc)" -I{} bash -c 'check_batch "$@"' - "--checks=$1" {} <"$build/together_$2.txt" ||
      failed=1
  fi
}

is_test='/(tests|bench)/'
run "$analyzer" sources "$(grep -Ev "$is_test" <<<"$known" || true)"
run "" tests "$(grep -E "$is_test" <<<"$known" || true)"
((failed == 0)) || exit 1
echo "$(wc -l <<<"$known") files linted"
