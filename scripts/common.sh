# Functions of the scripts in this folder. A script that sources it goes on in the repository, and ends at its first failure.
# shellcheck shell=bash disable=SC2034
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Where cargo builds, where scripts/package puts packages, and their version.
target=${CARGO_TARGET_DIR:-$PWD/target}
packages=$PWD/target/package
version=$(sed -n '0,/^version = /s/^version = "\(.*\)"/\1/p' Cargo.toml)

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

# Packages of the libraries that the window loads: the Debian package depends on them.
libraries() { sed -n 's/^depends = .* libgcc1, \(.*\)"$/\1/p' Cargo.toml | tr -d ,; }

# A folder and the processes in `started` last until the script ends.
work=$(mktemp -d)
started=()
finish() {
    kill "${started[@]}" 2>/dev/null || true
    rm -rf --one-file-system "$work"
}
trap finish EXIT

# server OPTIONS...: a virtual display, ready; its number is left in $number. Without -noreset it starts anew, and refuses programs meanwhile, when its
# last window closes.
server() {
    mkdir -p /tmp/.X11-unix
    read -r number < <(exec Xvfb -displayfd 1 -screen 0 1440x900x24 -nolisten tcp -ac -noreset "$@" 2>"$work/xvfb.log") ||
        fail "Xvfb did not start: $(cat "$work/xvfb.log")"
    started+=($!)
}

# own_display OPTIONS...: a display of this script's own, for all that it starts.
own_display() {
    unset WAYLAND_DISPLAY
    server "$@"
    export DISPLAY=:$number LIBGL_ALWAYS_SOFTWARE=1
}

# open WHAT COMMAND...: starts a program and waits for its window. They are left in $app and $window, what it writes to standard error in $work/said.
open() {
    local what=$1 start=$SECONDS
    "${@:2}" >"$work/printed" 2>"$work/said" &
    app=$!
    started+=("$app")
    until window=$(xdotool search --onlyvisible --name apertura 2>/dev/null | head -1) && [[ -n $window ]]; do
        kill -0 "$app" 2>/dev/null || fail "$what: the program ended before its window was there: $(cat "$work/said")"
        ((SECONDS - start < 90)) || fail "$what: no window within 90 s: $(cat "$work/said")"
        sleep 0.2
    done
    echo "${0##*/}: $what: the window is there after $((SECONDS - start)) s"
}

# fill PROGRAM ARGUMENTS...: opens the program with settings of its own; its window fills the display.
fill() {
    open "$1" env XDG_DATA_HOME="$(mktemp -d -p "$work")" XDG_CONFIG_HOME="$(mktemp -d -p "$work")" "$@"
    xdotool windowmove "$window" 0 0 windowsize "$window" 1440 900
    sleep "$(paced 3)"
    xdotool windowfocus "$window"
}

# look PICTURE: one of many colours is of a window or of maps, and not of an empty screen.
look() {
    local colours
    colours=$(identify -format %k "$1")
    ((colours > 500)) || fail "$1 has $colours colours; expected those of scene and maps"
    echo "${0##*/}: $1, $colours colours"
}

# picture NAME: what is on screen, for a person to look at.
picture() {
    mkdir -p "$packages/pictures"
    import -window root "$packages/pictures/$1.png"
    look "$packages/pictures/$1.png"
}

# says WHAT SENTENCE: whether the program that ran last wrote it to standard error, which is kept in $work/said.
says() { grep -qF "$2" "$work/said" || fail "$1: expected \"$2\", it said: $(cat "$work/said")"; }

# packed KIND NAME: the package of this name is left in $package.
packed() {
    package=$packages/$2
    [[ -f $package ]] || fail "$package is not there; scripts/package $1 makes it"
}

# none WHAT FIND-ARGUMENTS...: whether no such file is left.
none() {
    local left
    left=$(find "${@:2}")
    [[ -z $left ]] || fail "$1 leaves $left"
}

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

# paced SECONDS: as many on a quiet machine, PACE times as many on a busy one, where the window takes seconds for a frame.
paced() { awk -v seconds="$1" -v pace="${PACE:-1}" 'BEGIN { print seconds * pace }'; }

# press KEY...: each with a pause after it.
press() { for key; do xdotool key --clearmodifiers "$key" sleep "$(paced 1)"; done; }

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
    declare -F "${@/#/$prefix}" >/dev/null || fail "expected names of $(compgen -A function "$prefix" | tr '\n' ' ')"
    for name; do
        start=$SECONDS
        echo "== $name"
        "$prefix$name"
        times+=("$name: passed in $((SECONDS - start)) s")
    done
    printf '%s\n' "${times[@]}"
}
