# Functions of the scripts in this folder, which source it from the repository.
# shellcheck shell=bash

fail() { echo "${0##*/}: $*" >&2; exit 1; }

# apt PACKAGE...: installs Debian's packages.
apt() {
    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    echo "${0##*/}: installing $*" >&2
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2
}

# need PROGRAM:PACKAGE...: installs the packages of programs that are missing.
need() {
    local pair missing=()
    for pair; do command -v "${pair%%:*}" >/dev/null || missing+=("${pair##*:}"); done
    ((${#missing[@]} == 0)) || apt "${missing[@]}"
}

# The version of the program.
version() { sed -n '0,/^version = /s/^version = "\(.*\)"/\1/p' Cargo.toml; }

# A folder $work and the processes in `started` last until the script ends.
started=()
finish() {
    ((${#started[@]} == 0)) || kill "${started[@]}" 2>/dev/null || true
    [[ -z ${work:-} ]] || rm -rf --one-file-system "$work"
}
scratch() {
    work=$(mktemp -d)
    trap finish EXIT
}

# server NUMBER OPTIONS...: a virtual display, ready. Without -noreset it starts anew, and refuses programs meanwhile, when its last window closes.
server() {
    local number=$1
    shift
    mkdir -p /tmp/.X11-unix
    Xvfb ":$number" -screen 0 1440x900x24 -nolisten tcp -ac -noreset "$@" >"$work/xvfb-$number.log" 2>&1 &
    started+=($!)
    # Its socket is there before it listens.
    for _ in {1..100}; do DISPLAY=:$number xdotool getdisplaygeometry >/dev/null 2>&1 && return; sleep 0.1; done
    fail "Xvfb did not start: $(cat "$work/xvfb-$number.log")"
}

# own_display OPTIONS...: a display of this script's own, for all that it starts.
own_display() {
    export DISPLAY=:$((90 + RANDOM % 800)) LIBGL_ALWAYS_SOFTWARE=1
    unset WAYLAND_DISPLAY
    server "${DISPLAY#:}" "$@"
}

# await_window SECONDS WHAT [PROCESS]: waits for the window of a program that runs; its number is left in $window.
await_window() {
    local start=$SECONDS
    until window=$(xdotool search --onlyvisible --name apertura 2>/dev/null | head -1) && [[ -n $window ]]; do
        [[ -z ${3:-} ]] || kill -0 "$3" 2>/dev/null || fail "$2: the program ended before its window was there: $(cat "$work/said")"
        ((SECONDS - start < $1)) || fail "$2: no window within $1 s: $(cat "$work/said" 2>/dev/null)"
        sleep 0.2
    done
}

# open PROGRAM ARGUMENTS...: starts the program with settings of its own; its window fills the display. Its process is left in $app.
open() {
    XDG_DATA_HOME=$(mktemp -d -p "$work") XDG_CONFIG_HOME=$(mktemp -d -p "$work") "$@" 2>"$work/said" &
    app=$!
    started+=("$app")
    await_window 60 "$1" "$app"
    xdotool windowmove "$window" 0 0 windowsize "$window" 1440 900
    sleep 3
    xdotool windowfocus "$window"
}

# look PICTURE: one of many colours is of a window or of maps, and not of an empty screen.
look() {
    local colours
    colours=$(identify -format %k "$1")
    ((colours > 500)) || fail "$1 has $colours colours; expected those of scene and maps"
    echo "${0##*/}: $1, $colours colours"
}

# says WHAT SENTENCE: whether the program that ran last wrote it to standard error, which is kept in $work/said.
says() { grep -qF "$2" "$work/said" || fail "$1: expected \"$2\", it said: $(cat "$work/said")"; }

# on_clipboard WHAT TEXT: waits until another program finds the text on the clipboard.
on_clipboard() {
    local text=""
    for _ in {1..40}; do
        text=$(timeout 5 xclip -selection clipboard -o 2>/dev/null || true)
        [[ $text != *"$2"* ]] || return 0
        sleep 0.5
    done
    fail "$1: \"$2\" is not on the clipboard; it holds: $text"
}

# press KEY...: each with a pause after it.
press() { for key; do xdotool key --clearmodifiers "$key"; sleep "${PAUSE:-1}"; done; }

# share_clipboard FIRST: copies everything in the window, where a point stands at y_metres = FIRST, then pastes a point of another program.
share_clipboard() {
    press ctrl+a ctrl+c
    on_clipboard "a copied point" "y_metres = $1"
    printf '[[object]]\nkind = "point"\nx_metres = -7.75\ny_metres = 12.0\n' | xclip -selection clipboard -i
    # A pasted object stands beside where it was copied: its range alone stays.
    press ctrl+v ctrl+a ctrl+c
    on_clipboard "a pasted point" "y_metres = 12.0"
    on_clipboard "what was there before" "y_metres = $1"
    echo "${0##*/}: the clipboard, both ways"
}

# run_steps PREFIX NAME...: runs the functions PREFIXNAME one by one, and prints each one's time at the end.
run_steps() {
    local prefix=$1 name start times=()
    shift
    for name; do
        declare -F "$prefix$name" >/dev/null || fail "there is no \"$name\"; there are $(declare -F | sed -n "s/^declare -f $prefix//p" | tr '\n' ' ')"
    done
    for name; do
        start=$SECONDS
        echo "== $name"
        "$prefix$name"
        times+=("$name: passed in $((SECONDS - start)) s")
    done
    printf '%s\n' "${times[@]}"
}
