#include "client/render/antialiasing.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("automatic antialiasing is MSAA on a GPU, and off in software drawing", "[render]") {
  constexpr AntialiasingMeans kGpu{false, 8}, kSoftware{true, 4};
  for (const Quality quality : {Quality::medium, Quality::high}) {
    CHECK(usable(Antialiasing::automatic, quality, kGpu) == Antialiasing::msaa);
    CHECK(usable(Antialiasing::automatic, quality, kSoftware) == Antialiasing::off);
  }
  CHECK(usable(Antialiasing::automatic, Quality::low, kGpu) == Antialiasing::off);
  // A choice is kept, also in software drawing.
  for (const auto choice : {Antialiasing::off, Antialiasing::fxaa, Antialiasing::msaa})
    CHECK(usable(choice, Quality::low, kSoftware) == choice);
}

TEST_CASE("FXAA replaces an MSAA that the driver does not have", "[render]") {
  for (const int samples : {0, 1}) {
    const AntialiasingMeans old{false, samples};
    CHECK(usable(Antialiasing::msaa, Quality::high, old) == Antialiasing::fxaa);
    CHECK(usable(Antialiasing::automatic, Quality::high, old) == Antialiasing::off);
    CHECK(usable(Antialiasing::fxaa, Quality::high, old) == Antialiasing::fxaa);
  }
}

TEST_CASE("drivers that draw with the processor are known by their names", "[render]") {
  CHECK(is_software_renderer("llvmpipe (LLVM 15.0.6, 256 bits)"));
  CHECK(is_software_renderer("Google SwiftShader"));
  CHECK_FALSE(is_software_renderer("NVIDIA H200/PCIe/SSE2"));
  CHECK_FALSE(is_software_renderer(""));
}

TEST_CASE("antialiasing has names", "[render]") {
  for (const auto choice :
       {Antialiasing::automatic, Antialiasing::off, Antialiasing::fxaa, Antialiasing::msaa}) {
    CHECK(parse_antialiasing(to_string(choice)) == choice);
  }
  CHECK_FALSE(parse_antialiasing("").has_value());
  CHECK_FALSE(parse_antialiasing("4x").has_value());
}
