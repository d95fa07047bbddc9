// Pictures as PNG files. In a browser there are no files.
#pragma once
#include <string>

#include "client/render/image.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Writes a PNG file as write_output_file() does: a world or a key is never replaced, and after an
/// error no part of the new file is left. The error begins with the name of the file. Blocks on the
/// disk. In a browser it always fails.
Result<void, std::string> write_png(const std::string& file, const Image& image);

}  // namespace runstone
