#!/usr/bin/env bash
# Installs, uses, upgrades, removes and purges the packages in a bare Debian root. It runs in namespaces of its
# own (scripts/check-packages), so that it has a network without other machines, and leaves no process behind.
#   tests/packages/check_root.sh PACKAGES ROOT
# The folder ROOT is a bare Debian root, in which all packages that these ones need are downloaded.
set -euo pipefail
packages=$1 root=$2
world=/var/lib/runstone/world
fail() { echo "check_root: $*" >&2; exit 1; }
in_root() { chroot "$root" "$@"; }
as() { chroot "$root" setpriv --reuid="$1" --regid="$1" --init-groups "${@:2}"; }
control() { as runstone runstone-server control --world "$world" "$@"; }
apt() { in_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y "$@" >"$root/apt.log" 2>&1 || { cat "$root/apt.log"; fail "apt-get $*"; }; }
digest() { sha256sum <"$root$world/world.sqlite"; }

# Waits up to 30 s until the command succeeds.
wait_for() {
  local i
  for ((i = 0; i < 300; ++i)); do
    "$@" >/dev/null 2>&1 && return
    sleep 0.1
  done
  fail "$* did not succeed within 30 s; the log of the server: $(cat "$root/server.log")"
}
start_server() {
  as runstone runstone-server --world "$world" --create --config /etc/runstone/server.toml \
    </dev/null >>"$root/server.log" 2>&1 &
  server=$!
  wait_for control status
}
stop_server() {
  control stop >/dev/null
  wait "$server" || fail "the server ended with the code $?: $(cat "$root/server.log")"
}
answers() {
  local line
  exec 3<>/dev/tcp/127.0.0.1/8080 || return 1
  printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n' >&3
  read -r line <&3
  exec 3>&-
  [[ $line == "HTTP/1.1 200 "* ]]
}

# The package with another version.
newer() {
  rm -rf "$root/newer" && dpkg-deb -R "$packages"/runstone-"$1"_*.deb "$root/newer"
  sed -i 's/^Version: .*/&+newer/' "$root/newer/DEBIAN/control"
  dpkg-deb -Zgzip -b "$root/newer" "$root/packages/newer-$1.deb" >/dev/null
}

ip link set lo up
mount -t proc proc "$root/proc"
mkdir -p "$root/packages"
cp "$packages"/*.deb "$root/packages"
for deb in "$root"/packages/*_*.deb; do
  name=${deb##*/}
  mv "$deb" "$root/packages/${name%%_*}.deb"
done

begin=$(date +%s%N)
apt install /packages/runstone-server.deb
start_server
printf 'installed by one command and running after %d ms; the bar is 20000 ms\n' $((($(date +%s%N) - begin) / 1000000))
[ "$(in_root stat -c '%U %a' /var/lib/runstone)" = "runstone 700" ] || fail "/var/lib/runstone is open to others"
[ "$(in_root stat -c '%U %G %a' /run/runstone/web.sock)" = "runstone runstone-gateway 660" ] ||
  fail "the socket of the gateway is $(in_root stat -c '%U %G %a' /run/runstone/web.sock)"

apt install --no-install-recommends /packages/{runstone-tools,runstone-web,runstone-client,runstone-dev,librunstone0}.deb pkg-config
in_root /sbin/ldconfig -p | grep 'librunstone\.so\.0 ' >/dev/null || fail "the loader does not find librunstone.so.0"
for file in "$root"/usr/lib/pkgconfig/runstone-*.pc; do
  name=$(basename "$file" .pc)
  in_root pkg-config --exists --print-errors "$name" >"$root/apt.log" 2>&1 || { cat "$root/apt.log"; fail "pkg-config finds $name, but not what it needs"; }
done
as runstone-web runstone-web --config /etc/runstone/web.toml >>"$root/server.log" 2>&1 &
wait_for answers
as runstone-web ls "$world" >/dev/null 2>&1 && fail "the user of the gateway reads the world"
in_root runstone-bot --connect 127.0.0.1:4747 --count 2 --rate 10 --duration 3 >/dev/null 2>&1 || fail "the bots failed"
control log limit 5 | grep -q bot || fail "the log has no edit of a bot: $(control log limit 5)"
as runstone runstone-server backup --world "$world" --to /var/lib/runstone/backups/first >/dev/null
in_root runstone-client --version >/dev/null
stop_server
as runstone runstone-replay verify --world "$world" >/dev/null || fail "the world is damaged"

# An upgrade keeps the settings of the host and the world.
echo 'view_radius_max = 7' >>"$root/etc/runstone/server.toml"
before=$(digest)
newer server
apt install /packages/newer-server.deb
in_root dpkg-query -W -f '${Version}' runstone-server | grep -q newer || fail "the package was not upgraded"
grep -q '^view_radius_max = 7' "$root/etc/runstone/server.toml" || fail "the upgrade changed the settings of the host"
[ "$(digest)" = "$before" ] || fail "the upgrade changed the world"
start_server
control status >/dev/null
stop_server
before=$(digest)

apt remove runstone-server
[ ! -e "$root/usr/bin/runstone-server" ] || fail "the program stays after apt remove"
[ -f "$root/etc/runstone/server.toml" ] || fail "apt remove deleted the settings"
[ "$(digest)" = "$before" ] || fail "apt remove changed the world"
apt purge runstone-server runstone-web
[ ! -e "$root/etc/runstone" ] || fail "apt purge left /etc/runstone"
[ "$(digest)" = "$before" ] || fail "apt purge changed the world"
[ -f "$root/var/lib/runstone/backups/first/world.sqlite" ] || fail "apt purge deleted a backup"
grep -q '/var/lib/runstone stay' "$root/apt.log" || fail "apt purge does not say where the worlds are"

# The world is served by the package that is installed afterwards.
apt install /packages/runstone-server.deb
start_server
control log limit 5 | grep -q bot || fail "the world has lost its edits"
stop_server
rm -rf "$root$world" "$root/var/lib/runstone/backups/first"
apt purge runstone-server
[ ! -e "$root/var/lib/runstone" ] || fail "apt purge left empty folders"
echo "packages were installed, used, upgraded, removed and purged; the world stayed"
