# Compiler settings of our own targets; never exported to users of the library.
add_library(pirsim_flags INTERFACE)
target_compile_features(pirsim_flags INTERFACE cxx_std_20)
# Contraction would let the compiler fuse a*b+c differently from build to build: results must be the same bytes.
target_compile_options(pirsim_flags INTERFACE
  -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
if(PIRSIM_SANITIZE)
  target_compile_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE})
endif()
