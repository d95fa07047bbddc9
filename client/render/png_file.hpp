// Pictures as PNG files. In a browser there are no files.
#pragma once
#include <string>

#include "client/render/image.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Writes a PNG file as write_output_file() does: a world or a key is never replaced, and a file that
/// cannot be written completely is not there. The error begins with the name of the file. Waits for
/// the disk.
Result<void, std::string> write_png(const std::string& file, const Image& image);

}  // namespace runstone
