# shellcheck shell=bash
# Bare Debian systems to try things in, by debootstrap. To be sourced; what can't be done here ends the script with 77.

# bare_system ROOT [SUITE [MIRROR [PACKAGES]]]: makes one. Without more the suite, and the mirror, of this machine.
bare_system() {
  local root=$1 suite=${2:-$(. /etc/os-release && echo "$VERSION_CODENAME")} mirror=${3:-} packages=${4:-} components=main log
  if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
    echo "$0: NOT tried in a bare system: that needs root and debootstrap" >&2
    exit 77
  fi
  if [ -z "$mirror" ]; then  # one of the files may be missing
    mirror=$(sed -nE 's/^deb (\[[^]]*\] )?(http[^ ]*) .*/\2/p; s/^URIs: *([^ ]*).*/\1/p' /etc/apt/sources.list \
      /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)
  fi
  [[ "$mirror" != *ubuntu* ]] || components=main,universe
  log=$(debootstrap --variant=minbase --components="$components" ${packages:+"--include=$packages"} "$suite" "$root" ${mirror:+"$mirror"} 2>&1) || {
    tail -5 <<<"$log" >&2
    echo "$0: NOT tried in a bare $suite: debootstrap failed" >&2
    exit 77
  }
  cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
  cp /etc/apt/apt.conf.d/*prox* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  mkdir "$root/try"
}

# inside ROOT COMMANDS: for sh. /proc and /dev are mounted in a namespace that ends with the commands.
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} unshare --mount sh -euc \
    'mount -t proc proc "$0/proc"; mount --rbind /dev "$0/dev"; cd /; exec chroot "$0" sh -euc "$1"' "$1" "$2"
}
