// PageReply: what the server answers to the operators' page. Thread: any.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace runstone {

struct PageReply {
  enum class Kind : std::uint8_t {
    known,    // the server has answered
    unknown,  // the token or the link is not in force
    barred,   // the operator has no right that the page needs
    is_down   // the server is not running, or has no such page
  };
  /// How the answer ended. `late`: the server had not finished when the time was over.
  enum class End : std::uint8_t { ok, refused, unsaved, late };
  Kind kind = Kind::is_down;
  End end = End::refused;
  std::vector<std::string> lines;  // behind the first one

  bool is_ok() const { return kind == Kind::known && end != End::refused; }
  /// Returns what stands behind "NAME " on the first line that begins so, or an empty text.
  std::string value(std::string_view name) const;
};

/// Parses what the server has sent so far. An answer that is not complete ends `late`.
PageReply parse_page_reply(std::string_view text);
/// Returns true if the text ends with the last line of an answer.
bool is_whole_page_reply(std::string_view text);

}  // namespace runstone
