# shellcheck shell=bash
# Shared by demo.sh and test.sh: progress with elapsed times, and one plain sentence on failure.
step_name="Starting"
log_file=

# Says what is going on, with minutes and seconds since the start.
step() {
    step_name="$1"
    printf '[%d:%02d] %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$1"
}

# Runs a command with its output kept in a file, of which the end is shown on failure.
quietly() {
    log_file="$1"
    shift
    mkdir -p "$(dirname "$log_file")"
    "$@" >"$log_file" 2>&1
    log_file=
}

finish() {
    local code=$?
    [ "$code" = 0 ] && return
    if [ -n "$log_file" ]; then tail -n 30 "$log_file" >&2; fi
    echo "Failed: the step '$step_name' did not succeed${log_file:+; all of its output is in $log_file}." >&2
}
trap finish EXIT
