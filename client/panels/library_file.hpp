// The file of a build of the library (.rsb, docs/builds.md) in memory, and the build as the clipboard
// of the tools holds it. Thread: any; both functions may take seconds for a town.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "client/render/overlay_frame.hpp"
#include "common/builds/build.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/build_info.hpp"
#include "common/core/bytes.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// A build of the library, and its picture.
struct LibraryBuild {
  BuildInfo info;
  BuildPtr build;
  std::vector<MaterialRow> rows;  // by palette entry of the build
  std::shared_ptr<const OverlayImage> picture;
};

/// Reads a file. No byte is trusted. Fails with one line that names the block and its place.
Result<LibraryBuild, std::string> read_library_file(const Bytes& file);

/// Writes a build as a file, with `rows` as the materials of its palette. With `empty` skipped, empty
/// cells are written as untouched. Fails with one line, also if the file would have more than
/// `bytes_max`.
Result<Bytes, std::string> write_library_file(const Build& build,
                                              const std::vector<MaterialRow>& rows, BuildInfo info,
                                              EmptyCells empty, std::uint64_t bytes_max);

/// Returns the info of a build that a player names: `name` and `tags`, which have commas between them,
/// without the blanks at their ends, and `author` if it can be one. Fails with one line if the server
/// would refuse the texts.
Result<BuildInfo, std::string> named_build(const std::string& name, const std::string& tags,
                                           const std::string& author);

}  // namespace runstone
