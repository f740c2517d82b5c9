from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Openmesh(CMakePackage):
    """Data structure for polygonal meshes."""

    homepage = "https://www.graphics.rwth-aachen.de/software/openmesh/"
    # As Debian keeps it.
    url = "https://deb.debian.org/debian/pool/main/o/openmesh/openmesh_9.0.orig.tar.gz"

    license("BSD-3-Clause", checked_by="pirsim")

    version("9.0", sha256="4df84295f5cca86b1ae8bfee8ff4db5efb6850e4e5b571ad0199147176dea796")

    depends_on("c", type="build")
    depends_on("cxx", type="build")

    def cmake_args(self):
        return [
            self.define("BUILD_APPS", False),
            self.define("OPENMESH_BUILD_PYTHON_BINDINGS", False),
        ]
