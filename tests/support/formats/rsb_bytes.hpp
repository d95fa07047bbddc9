// An .rsb in memory, random builds, and damage to it that checksums cannot see.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "common/core/hash.hpp"
#include "common/formats/rsb_reader.hpp"
#include "common/formats/rsb_writer.hpp"

namespace runstone::test {

/// A build in memory.
struct SampleBuild {
  BuildInfo info;
  std::vector<BuildMaterial> materials;
  std::vector<BuildSection> sections;  // ascending by number
};

/// Returns an info that differs from the default in every field.
BuildInfo sample_build_info(BuildSides sides = {70, 3, 2});
/// Returns `count` materials that ascend, some with states, looks and bodies. Requires 1 <= count
/// <= 65535.
std::vector<BuildMaterial> sample_build_materials(std::size_t count = 3);
/// Returns a build with sides 1 .. 200 whose sections have any shape, and some of whose sections do
/// not exist.
SampleBuild random_build(SplitMix64& rng);

/// Returns the whole file. Fails an assertion if the build is not valid.
Bytes rsb_of(const SampleBuild& build, int zstd_level);

/// The readable part of a file, and the error that ends it. Its cells are in AxisOrder::xyz.
struct RsbContents {
  SampleBuild build;
  std::optional<RsbError> error;
};
RsbContents read_rsb(ByteView file);

/// Returns where the blocks of a valid file begin, the end block included, and last the length of
/// the file.
std::vector<std::size_t> rsb_blocks_of(const Bytes& file);

/// Corrects every checksum and position, as far as the headers' lengths lead.
void mend_rsb(Bytes& file);

}  // namespace runstone::test
