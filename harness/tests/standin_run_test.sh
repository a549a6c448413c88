#!/usr/bin/env bash
# standin_run.sh never passes what was not judged. A script plays whirl: at which paces it is late, LATE_AT says, and the
# run's exit code is CODE.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/whirl" <<'PLAYED'
#!/usr/bin/env bash
given="0.00 s given up"
if [[ $1 == standin ]]; then
  while [[ $1 != --pace ]]; do shift; done
  echo "$2" >"$PLAYED/pace"
  echo "esc stands in"
  if [[ " ${LATE_AT:-} " == *" $2 "* ]]; then given="0.12 s given up"; fi
  trap 'echo "1 of 9 steps late, $given"; exit' TERM
  while :; do sleep 0.05; done
fi
pace=$(cat "$PLAYED/pace")
if [[ " ${HOST_LATE_AT:-} " == *" $pace "* ]]; then echo "the host was late: 9 of 9 steps"; exit 3; fi
exit "${CODE:-0}"
PLAYED
chmod +x "$folder/whirl"
export PLAYED=$folder

# expect CODE WORDS PACES [NAME=VALUE...]
expect() {
  local want=$1 words=$2 paces=$3 status=0
  shift 3
  env "$@" bash "$here/standin_run.sh" "$folder/whirl" can "$paces" >"$folder/said" 2>&1 || status=$?
  if ((status != want)) || ! grep -q "$words" "$folder/said"; then
    echo "$* at $paces: exit code $status, not $want, or no '$words':"
    cat "$folder/said"
    exit 1
  fi
}

expect 0 'at pace 0.5$' 0.5,0.1 CODE=0
expect 0 'took . s at pace 0.1$' 0.5,0.1 LATE_AT=0.5
expect 0 'not judged at pace 0.5, the host was late' 0.5,0.1 HOST_LATE_AT=0.5
expect 1 'nothing was shown of can: at the slowest pace, 0.1, the stand-in was late' 0.5,0.1 'LATE_AT=0.5 0.1'
expect 1 'nothing was shown of can: at the slowest pace, 0.5, the host was late' 0.5 HOST_LATE_AT=0.5
expect 1 'nothing was shown of can' 0.5 LATE_AT=0.5 WHIRL_OWN_CLOCK=1
expect 1 'at pace 0.5$' 0.5,0.1 CODE=1
