// Builds for tests of readers and writers of files.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/hash.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone::test {

/// Returns a build. `number` returns 0 for an untouched cell, otherwise an index of `materials` + 1.
FileBuild file_build(VoxelPos sides, const std::vector<BuildMaterial>& materials,
                     const std::function<std::uint16_t(VoxelPos)>& number);

/// Returns a material. An opaque one has alpha 255; the name "air" is empty.
BuildMaterial file_material(std::string name, std::string states, MaterialColour colour);

/// Returns a build of random runs, untouched cells included, with at most `count` solid materials; with
/// air on request.
FileBuild random_file_build(SplitMix64& rng, VoxelPos sides, std::uint16_t count, bool has_air);

/// Returns all cells, x fastest, then y, then z: name, states and colour; "-": untouched.
std::vector<std::string> cell_texts(const FileBuild& build);

/// Returns what a writer writes, or fails as it does.
Result<Bytes> written(Result<void> (*write)(const FileBuild&, const FormatSink&),
                      const FileBuild& build);

/// Reads a file with every prefix of it, and returns the lengths that were no error.
std::vector<std::size_t> lengths_without_error(const Format& format, const Bytes& file);

}  // namespace runstone::test
