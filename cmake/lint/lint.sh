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

# check_batch BUILD CHECKS LIST: the listed files as one file, for the analyzer looks at no included one. Files of
# which the compiler says that they don't go together, go by halves; a file of which anything is said, goes alone.
check_batch() {
  local said options half file failed=0 alone=0
  mapfile -t options <"$3.options"
  options+=(-Xclang -analyzer-config -Xclang "max-nodes=$nodes")
  while read -r file; do printf '// file: %s\n' "$file" && cat "$file"; done <"$3" >"$3.cpp"
  said=$(clang-tidy-14 --quiet "$2" "$3.cpp" -- "${options[@]}" 2>&1) && return 0
  if (($(wc -l <"$3") > 1)) && grep -q 'clang-diagnostic-error' <<<"$said"; then
    split -n r/2 "$3" "$3_"  # by lines: by bytes, a short path and a longer one would stay together for ever
    for half in "$3_aa" "$3_ab"; do
      cp "$3.options" "$half.options"
      check_batch "$1" "$2" "$half" || failed=1
    done
    return "$failed"
  fi
  grep ': error:' <<<"$said" | grep -vF "$3.cpp:" || true  # in headers
  while read -r file; do
    check "$1" "$2" "$file" || alone=1
  done < <(sed -n "s,^$3.cpp:\([0-9]*\):.*error:.*,\1,p" <<<"$said" | sort -un | while read -r line; do
    head -n "$line" "$3.cpp" | sed -n 's,^// file: ,,p' | tail -n 1
  done | sort -u)
  ((alone)) || echo "$said"  # alone, none of them has anything to say
  return 1
}
export -f check check_batch
# States of one function that the analyzer looks at in a batch; alone, a file gets clang's 225 000, for four times
# the time.
export nodes=50000

failed=0
# run CHECKS NAME FILES
run() {
  [[ -n $3 ]] || return 0
  if ((one_by_one)); then
    xargs -P "$(nproc)" -I{} bash -c 'check "$@"' - "$build" "--checks=$1" {} <<<"$3" || failed=1
  else
    # shellcheck disable=SC2086  # no name of ours has a space
    python3 "$here/batches.py" "$build" "$build/together/$2" $3 >"$build/together_$2.txt"
    xargs -P "$(nproc)" -I{} bash -c 'check_batch "$@"' - "$build" "--checks=$1" {} <"$build/together_$2.txt" ||
      failed=1
  fi
}

is_test='/(tests|bench)/'
run "$analyzer" sources "$(grep -Ev "$is_test" <<<"$known" || true)"
run "" tests "$(grep -E "$is_test" <<<"$known" || true)"
((failed == 0)) || exit 1
echo "$(wc -l <<<"$known") files linted"
