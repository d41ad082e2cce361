# The program and the libraries. `source`: the tree of the project.
{ lib, stdenv, source, cmake, ninja, pkg-config, cli11, draco, expat, fmt, giflib, libdeflate, libjpeg, libspng, libwebp, meshoptimizer
, nlohmann_json, openexr, stb, tl-expected, xsimd, zstd }:

stdenv.mkDerivation {
  pname = "halflit";
  version = builtins.head (builtins.match ".*\nproject\\(halflit VERSION ([0-9.]+) .*" (builtins.readFile "${source}/CMakeLists.txt"));
  src = source;

  nativeBuildInputs = [ cmake ninja pkg-config ];
  buildInputs = [ cli11 draco expat fmt giflib libdeflate libjpeg libspng libwebp meshoptimizer nlohmann_json openexr stb xsimd zstd ];
  propagatedBuildInputs = [ tl-expected ];
  cmakeFlags = [ "-DHALFLIT_SHARED=ON" "-DHALFLIT_BUILD_TESTS=OFF" "-DHALFLIT_VIEWER=OFF" ];

  doInstallCheck = true;
  installCheckPhase = "$out/bin/halflit --self-test";

  meta = {
    description = "Software rasterizer: renders models to pictures on the CPU";
    license = lib.licenses.mit;
    platforms = lib.platforms.linux;
    mainProgram = "halflit";
  };
}
