#!/usr/bin/env bash
# Checks packages without installing them: their lists of files, lintian, the hardening of the units, desktop
# file and metainfo, man pages and completions.
#   tests/packages/check_files.sh PACKAGES WORK
# PACKAGES is the folder of scripts/package, WORK one for what is unpacked.
set -euo pipefail
packages=$1 work=$2
fail() { echo "check_files: $*" >&2; exit 1; }

rm -rf "$work"
for name in server client tools web dev library; do
  full=runstone-$name
  [ "$name" != library ] || full=librunstone0
  package=("$packages"/"$full"_*.deb)
  [ -f "${package[0]}" ] || fail "$packages has no package $full"
  mkdir -p "$work/$name"
  dpkg-deb -R "${package[0]}" "$work/$name"
  for file in copyright changelog.gz CHANGELOG.md.gz; do
    [ -f "$work/$name/usr/share/doc/$full/$file" ] || fail "$full has no $file"
  done
done

[ -f "$work/library/usr/lib/librunstone.so.0" ] || fail "librunstone0 has no librunstone.so.0"
[ ! -e "$work/library/DEBIAN/postinst" ] || fail "librunstone0 has a script, which its trigger replaces"

# Three tags are left out: the default address of the maintainer is no real one, and the libraries are in
# /usr/lib, where the preset release has them.
lintian --allow-root --no-cfg --fail-on error,warning --suppress-tags \
  bogus-mail-host,bogus-mail-host-in-debian-changelog,pkg-config-unavailable-for-cross-compilation \
  "$packages"/*.deb || fail "lintian found faults"

for program in "$work"/*/usr/bin/*; do
  name=$(basename "$program") tree=${program%/usr/bin/*}
  man=$tree/usr/share/man/man1/$name.1.gz
  [ -f "$man" ] || fail "$name has no man page"
  warnings=$(man --warnings --encoding=UTF-8 --local-file -Tutf8 -Z "$man" 2>&1 >/dev/null)
  [ -z "$warnings" ] || fail "man page of $name: $warnings"
  bash -n "$tree/usr/share/bash-completion/completions/$name" || fail "completion of $name for bash"
  zsh -n "$tree/usr/share/zsh/vendor-completions/_$name" || fail "completion of $name for zsh"
  fish --no-execute "$tree/usr/share/fish/vendor_completions.d/$name.fish" || fail "completion of $name for fish"
done

# What bash offers for a line of words, of which the last one is being typed.
offered() {
  bash -c 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _runstone_server; echo "${COMPREPLY[*]}"' \
    "$work/server/usr/share/bash-completion/completions/runstone-server" "$@"
}
expect() {
  local expected=$1
  shift
  [ "$(offered "$@")" = "$expected" ] || fail "bash offers \"$(offered "$@")\" for \"$*\", not \"$expected\""
}
expect "backup" runstone-server ba
expect "--world" runstone-server backup --wor
expect "luanti" runstone-server import lu
expect "default none" runstone-server import --palette ""
expect "" runstone-server backup --world ""  # bash goes on with names of files
expect "backup" runstone-server --world import ba
expect "backup" runstone-server --world = import ba
expect "default none" runstone-server import --palette =
expect "none" runstone-server import --palette = n
expect "" runstone-server backup --world = ""

# What fish offers, which knows the description of each as well.
fish_offers() {
  fish --no-config -c 'source $argv[1]; complete -C $argv[2]' \
    "$work/server/usr/share/fish/vendor_completions.d/runstone-server.fish" "$1" | cut -f 1 | tr '\n' ' '
}
[[ " $(fish_offers 'runstone-server ')" == *" backup "* ]] || fail "fish offers no backup: $(fish_offers 'runstone-server ')"
[[ " $(fish_offers 'runstone-server backup --')" == *" --world "* ]] || fail "fish offers no option of backup"
[ "$(fish_offers 'runstone-server import --palette ')" = "default none " ] || fail "fish offers no values of --palette"

units=("$work"/{server,web}/usr/lib/systemd/system/*.service)
[ ${#units[@]} -eq 3 ] || fail "there are ${#units[@]} services, not 3"
for unit in "${units[@]}"; do
  # The exposure may be 1.5.
  systemd-analyze security --offline=true --threshold=15 --no-pager "$unit" | tail -1
done

desktop-file-validate "$work"/client/usr/share/applications/*.desktop
appstreamcli validate --no-net "$work"/client/usr/share/metainfo/*.xml
echo "the files of all packages are right"
