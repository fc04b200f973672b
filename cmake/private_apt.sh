# shellcheck shell=bash
# Downloads Debian packages to unpack them, not to install them: apt with its own state folder. Its only sources are the
# named suites of the archive that this machine's apt already uses. Needs no root and does not change the system. To be
# sourced.
#
#   private_apt_archive                              prints the archive, or fails
#   private_apt_open FOLDER ARCHIVE SUITE...         reads the suites' package indices into FOLDER
#   private_apt_cache ...                            apt-cache on them
#   private_apt_download FOLDER PACKAGE/SUITE...
#
# Options for apt may be added to private_apt_options before the first call.
private_apt_options=()

private_apt_archive() {
  command -v apt-get >/dev/null || return
  apt-get indextargets --format '$(REPO_URI)|$(COMPONENT)|$(ORIGIN)' 'Created-By: Packages' |
    awk -F'|' '$2 == "main" && $3 == "Debian" { print $1; found = 1; exit } END { exit !found }'
}

private_apt_open() {
  local state=$1 archive=$2 suite
  mkdir -p "$state"/{lists/partial,cache/archives/partial}
  for suite in "${@:3}"; do
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $archive $suite main"
  done >"$state/sources.list"
  private_apt_options+=(-o Dir::State::lists="$state/lists" -o Dir::Etc::sourcelist="$state/sources.list"
    -o Dir::Etc::sourceparts=- -o Dir::Cache="$state/cache")
  private_apt_get update
}

private_apt_get() { apt-get -qq "${private_apt_options[@]}" -o APT::Sandbox::User= "$@"; }
private_apt_cache() { apt-cache "${private_apt_options[@]}" "$@"; }
private_apt_download() { (cd "$1" && private_apt_get download "${@:2}"); }
