// A client in a browser has no fonts.
#include "client/lettering/font_file.hpp"
#include "client/lettering/text_build.hpp"

namespace runstone {
namespace {

constexpr const char* kNoFonts = "a client in a browser writes no text: it has no fonts";

}  // namespace

Result<FontPtr, std::string> read_font(const std::string&) {
  return failure(std::string(kNoFonts));
}

Result<void, std::string> check_text(std::string_view) { return failure(std::string(kNoFonts)); }

Result<BuildPtr, std::string> text_build(ByteView, std::string_view, const TextStyle&, Material) {
  return failure(std::string(kNoFonts));
}

}  // namespace runstone
