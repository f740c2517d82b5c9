import os

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Pirsim(CMakePackage):
    """Headless simulator of passive-infrared motion sensors."""

    homepage = "https://doi.org/10.3390/s21238078"
    # The source archive that CPack makes lies where `spack install` is typed.
    url = f"file://{os.getcwd()}/pirsim-0.2.0.tar.gz"
    manual_download = True

    license("Apache-2.0", checked_by="pirsim")

    # No checksum: the archive tells its revision. `spack install --no-checksum pirsim`.
    version("0.2.0")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.9:", type="build")

    depends_on("cli11@2.1:", type="build")
    depends_on("random123", type="build")
    depends_on("stb", type="build")
    depends_on("eigen@3.4", type="build")
    depends_on("boost@1.74:", type="build")
    depends_on("glm@0.9.9.8:")
    depends_on("embree@3.12:4")
    depends_on("openmesh@9:")
    depends_on("tinygltf@2.6:")
    depends_on("yaml-cpp@0.7:")
    depends_on("nlohmann-json@3.10:")
    depends_on("nlopt@2.7:+cxx")
    depends_on("zlib-api")
    depends_on("zstd@1.4:")
    depends_on("sqlite@3.22:")
    depends_on("openssl@3:")
    depends_on("date@3: +tz tzdb=system")

    # Draws the charts of reports; built into the library.
    resource(
        name="vega",
        url="https://registry.npmjs.org/vega/-/vega-5.33.0.tgz",
        sha256="7b61f992d1a1e196e7f2eeb3d6176e5694949d0d4bbfea237a842d523dd6e1f3",
        placement="vega",
    )

    generator("ninja")

    def cmake_args(self):
        vega = join_path(self.stage.source_path, "vega", "build")
        return [
            self.define("PIRSIM_BUILD_TESTS", False),
            self.define("VEGA_DIR", vega),
            self.define("RANDOM123_INCLUDE_DIR", self.spec["random123"].prefix.include),
            self.define("STB_INCLUDE_DIR", self.spec["stb"].prefix.include),
        ]
