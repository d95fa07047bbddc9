// Font files: the bytes of a font of this computer. Reads files.
#pragma once
#include <memory>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

using FontPtr = std::shared_ptr<const Bytes>;

/// The font that the installation of the client brings.
inline constexpr const char* kDefaultFont = "DejaVuSans";

/// Reads a font: a path with a slash, or the name of a file without its folder and with or without
/// its ending, such as DejaVuSans-Bold. A name is searched in the folders in which systems keep
/// fonts, and in their subfolders. Fails with words for the player that name the file or the
/// folders that were searched. Cost: the files of these folders are listed, and one is read.
Result<FontPtr, std::string> read_font(const std::string& name);

}  // namespace runstone
