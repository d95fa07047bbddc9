// write_png() of the client for browsers, where png_file.cpp is left out.
#include "client/render/png_file.hpp"

namespace runstone {

Result<void, std::string> write_png(const std::string& file, const Image&) {
  return failure(file + ": cannot be written: a page has no files");
}

}  // namespace runstone
