#include "client/render/png_file.hpp"

#include "common/os/output_file.hpp"

namespace runstone {

Result<void, std::string> write_png(const std::string& file, const Image& image) {
  const Bytes bytes = encode_png(image);
  if (bytes.empty()) return failure(file + ": cannot be written: no memory for the picture");
  return write_output_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace runstone
