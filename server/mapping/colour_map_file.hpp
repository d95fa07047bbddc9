// The file with the colours of a height map.
#pragma once
#include <string>

#include "common/core/result.hpp"
#include "common/formats/build_of_file.hpp"

namespace runstone {

/// Reads the file of a PNG into `bytes`, and sets the colours of `reading` to it; `bytes` must
/// outlive its use. Does nothing if `file` is empty. The error is one line that begins with the
/// name of the file. Fails if the file is empty, too large, or a pipe or a device. Blocks on the
/// disk.
Result<void, std::string> add_colour_map(const std::string& file, std::string& bytes,
                                         ForeignReading& reading);

}  // namespace runstone
