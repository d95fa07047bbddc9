// LuaTokens: the words of a text in Lua, for a scan that runs nothing. Every text can be read: a
// string or comment without an end ends with the text.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace runstone {

struct LuaToken {
  enum class Kind : std::uint8_t { end, text, name, sign };
  Kind kind = Kind::end;
  std::string text;  // of a string without its quotes; of a sign one character, ".." as it is
  bool is_sign(std::string_view sign) const { return kind == Kind::sign && text == sign; }
};

class LuaTokens {
 public:
  explicit LuaTokens(std::string_view text) : text_(text) {}
  /// Returns the next word; comments and blanks are left out. At the end of the text returns a
  /// token of kind end. Cost: O(bytes of the token and what is left out).
  LuaToken next();

 private:
  /// Returns the bytes of a long string or comment that begins here with [[ or [=[, and passes it.
  /// Returns false if none begins here.
  bool take_long(std::string& out);
  void pass_blanks();
  LuaToken take_quoted();

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace runstone
