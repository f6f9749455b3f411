# Debian packages and Debian source packages. Source this file; it needs `say` and `fail`. No host is named here:
# everything comes through the machine's own entries in /etc/apt.

apt_updated=no
apt_log=${apt_log:-${GRIDMORPH_DEPS_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/gridmorph}/apt.log}
apt_patience=900 apt_pause=3 # seconds to wait for another installation, in all and between two looks

have_apt() { command -v apt-get >/dev/null 2>&1; }

# apt_run ARGUMENT...: apt-get, whose talk goes to the end of $apt_log. Only one installation has the package database at a time, and a fresh
# machine often runs one of its own: this one waits for its end.
apt_run() {
  local talk waited=no start=$SECONDS
  mkdir -p "$(dirname "$apt_log")"
  while :; do
    talk=$(DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -q "$@" 2>&1) && break
    printf '%s\n' "$talk" >>"$apt_log"
    if ! grep -q 'Could not get lock\|Unable to acquire\|Unable to lock' <<<"$talk" || ((SECONDS - start >= apt_patience)); then
      tail -n 20 <<<"$talk" >&2
      fail "apt-get ${*: -1} failed; all that it said is in $apt_log"
    fi
    [ $waited = yes ] || say "waiting for another installation to end: $(grep -m 1 -o 'Could not get lock.*\|Unable to.*' <<<"$talk")"
    waited=yes
    sleep "$apt_pause"
  done
  printf '%s\n' "$talk" >>"$apt_log"
}

apt_update() {
  [ $apt_updated = no ] || return 0
  say "updating the list of Debian packages"
  apt_run update
  apt_updated=yes
}

# apt_offers PACKAGE VERSION: whether root could install that version of the package or a newer one.
apt_offers() {
  local version
  have_apt && [ "$(id -u)" -eq 0 ] || return 1
  apt_update
  version=$(LC_ALL=C apt-cache policy "$1" | sed -n 's/^ *Candidate: //p')
  [ -n "$version" ] && [ "$version" != "(none)" ] && dpkg --compare-versions "$version" ge "$2"
}

# apt_install PACKAGE...: installs what dpkg does not know yet. Root only.
apt_install() {
  local missing=() package
  [ $# -gt 0 ] || return 0
  for package in "$@"; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      missing+=("$package")
    fi
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  have_apt || fail "these are missing and there is no apt-get here to install them; install what they stand for: ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || fail "these Debian packages are missing; run as root: apt-get install ${missing[*]}"
  apt_update
  say "installing Debian packages: ${missing[*]}"
  apt_run -y --no-install-recommends install "${missing[@]}"
}

# debian_source_entry SUITE: the machine's own entry for the Debian archive, rewritten to source packages of SUITE.
# Prints deb822 or one-line format; the entry taken is the one that lists the machine's own release, by its name or by what Debian calls it now.
debian_source_entry() {
  local suite=$1 own file
  own="$(. /etc/os-release && echo "${VERSION_CODENAME:-stable}")|stable|testing|unstable|sid"
  for file in /etc/apt/sources.list.d/*.sources; do
    [ -e "$file" ] || continue
    sed '/^#/d' "$file" | awk -v own="$own" -v suite="$suite" '
      BEGIN { RS = ""; FS = "\n" }
      /(^|\n)Types:[^\n]*deb([ \n]|$)/ && !/(^|\n)Enabled: *no/ {
        found = 0
        for (i = 1; i <= NF; i++) if ($i ~ "^Suites:" && ($i " ") ~ "[ \t](" own ")[ \t]") found = 1
        if (!found) next
        for (i = 1; i <= NF; i++) {
          if ($i ~ /^Types:/) $i = "Types: deb-src"
          if ($i ~ /^Suites:/) $i = "Suites: " suite
          if ($i ~ /^Components:/) $i = "Components: main"
          print $i
        }
        exit
      }'
  done >"$entry_file.sources"
  if [ -s "$entry_file.sources" ]; then
    echo "$entry_file.sources"
    return 0
  fi
  cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null |
    sed -nE "s/^deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[:space:]]+)[[:space:]]+($own)[[:space:]].*/deb-src \1\2 $suite main/p" |
    head -n 1 >"$entry_file.list"
  [ -s "$entry_file.list" ] || return 1
  echo "$entry_file.list"
}

# fetch_debian_source PACKAGE SUITE FOLDER: puts the upstream archive of a Debian source package into FOLDER and prints
# its path. apt checks signatures and hashes; a mirror that stands still is welcome, since any version in the suite will
# do. Touches none of the machine's apt configuration.
fetch_debian_source() {
  local package=$1 suite=$2 folder=$3 log="$3/apt.log" entry_file entry options
  have_apt || return 1
  mkdir -p "$folder/lists/partial"
  entry_file="$folder/$suite"
  if ! entry=$(debian_source_entry "$suite"); then
    say "no entry for the Debian archive in /etc/apt"
    return 1
  fi
  options=(-q -o "Dir::Etc::sourcelist=$entry" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$folder/lists"
    -o Acquire::Check-Valid-Until=false -o APT::Sandbox::User=root)
  if ! (cd "$folder" && apt-get "${options[@]}" update &&
    apt-get "${options[@]}" source --download-only --tar-only "$package") >"$log" 2>&1; then
    say "no source package $package in $suite: $(sed -n '/^E: /{s///p;q}' "$log")"
    return 1
  fi
  find "$folder" -maxdepth 1 -name "${package}_*.orig.tar.*" ! -name '*.asc' | grep -m 1 .
}
