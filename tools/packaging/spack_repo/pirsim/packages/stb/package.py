from spack_repo.builtin.build_systems.generic import Package

from spack.package import *


class Stb(Package):
    """Single-file libraries for C and C++, among them a writer of PNG."""

    homepage = "https://github.com/nothings/stb"
    # As Debian keeps it.
    url = "https://deb.debian.org/debian/pool/main/libs/libstb/libstb_0.0~git20220908.8b5f1f3+ds.orig.tar.xz"

    license("MIT OR Unlicense", checked_by="pirsim")

    version(
        "2022.09.08",
        sha256="6949c8ff9f86d982cff1b384f1301a731cbaf3b3fa4d1728c7b48a02386d31d8",
        url="https://deb.debian.org/debian/pool/main/libs/libstb/libstb_0.0~git20220908.8b5f1f3+ds.orig.tar.xz",
    )

    def install(self, spec, prefix):
        target = join_path(prefix.include, "stb")
        mkdirp(target)
        install("*.h", target)
