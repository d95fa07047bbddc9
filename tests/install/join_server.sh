#!/usr/bin/env bash
# Runs a server on a new world, and a program that gets its address.
#   tests/install/join_server.sh SERVER PROGRAM WORK
set -euo pipefail
server=$1 program=$2 work=$3
rm -rf "$work/world" "$work/port"
"$server" --world "$work/world" --create --generator flat --listen 127.0.0.1:0 --port-file "$work/port" \
  > "$work/server.log" 2>&1 &
running=$!
trap 'kill "$running" && wait "$running" || true' EXIT
for _ in $(seq 200); do
  [ ! -s "$work/port" ] || break
  sleep 0.1
done
timeout 60 "$program" "127.0.0.1:$(cat "$work/port")"
