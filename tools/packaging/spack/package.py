# A recipe for Spack (https://spack.io): put it into the folder packages/pirsim of a repository of your own, then
# `spack install pirsim`. The url is filled in when a release has one; until then it installs a clone:
# `spack dev-build pirsim@main`.
from spack.package import *


class Pirsim(CMakePackage):
    """Headless simulator of passive-infrared (PIR) motion sensors: labelled data, coverage maps, and what a model
    lacks beside measurements."""

    homepage = "https://doi.org/10.3390/s21238078"

    license("Apache-2.0")

    version("main")

    variant("tests", default=False, description="build the tests")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("python@3.9:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("embree@3:4")
    depends_on("glm")
    depends_on("tinygltf")
    depends_on("openmesh")
    depends_on("yaml-cpp")
    depends_on("nlohmann-json")
    depends_on("cli11")
    depends_on("random123")
    depends_on("stb")
    depends_on("nlopt +cxx")
    depends_on("eigen@3:")
    depends_on("boost")
    depends_on("zlib-api")
    depends_on("zstd")
    depends_on("openssl")
    depends_on("catch2@2:3", when="+tests")

    generator("ninja")

    def cmake_args(self):
        return [self.define_from_variant("PIRSIM_BUILD_TESTS", "tests")]
