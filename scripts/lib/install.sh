# Sourced. install_packages SET...: installs the Debian packages of these sets that are missing
# (scripts/packages), says which, and uses sudo only when not root.
install_packages() {
  local wanted=() missing=() package set
  while read -r set package; do
    case " $* " in *" $set "*) wanted+=("$package") ;; esac
  done < <(grep -v '^#' "$root/scripts/packages")
  for package in "${wanted[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "installing ${#missing[@]} Debian packages: ${missing[*]}"
  local sudo=""
  [ "$(id -u)" -eq 0 ] || sudo="sudo"
  $sudo apt-get update -qq
  DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# build PRESET [TARGET...]: configures once, then builds. The presets bench and python are the folder of
# the preset release with the benchmarks, or the module of Python, switched on. In a terminal Ninja shows its progress
# line; in a log it prints errors only.
build() {
  local preset=$1 quiet=--quiet made="$root/build/$1/build.ninja"
  shift
  [ -t 1 ] && quiet=
  [ "$preset" = bench ] && made="$root/build/release/bench/cmake_install.cmake"
  [ "$preset" = python ] && made="$root/build/release/bindings/python/cmake_install.cmake"
  [ -f "$made" ] || (cd "$root" && cmake --preset "$preset" >/dev/null)
  (cd "$root" && cmake --build --preset "$preset" ${1:+--target "$@"} -- $quiet)
}

# Runs the rest of the line and prints how long it took.
step() {
  local name=$1 start=$SECONDS
  shift
  echo "== $name"
  "$@"
  echo "== $name: $((SECONDS - start)) s"
}
