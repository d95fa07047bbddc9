#include "protocol/codec/password_key.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a key fits the password that it was made of, and no other salt", "[protocol]") {
  const PasswordSalt salt{1}, other{2};
  const auto kept = join_password("correct horse", salt, "builder");
  REQUIRE(kept.has_value());
  CHECK(kept->role == "builder");
  CHECK(kept->salt == salt);
  CHECK(is_key_of(*kept, password_key("correct horse", salt).value()));
  CHECK_FALSE(is_key_of(*kept, password_key("correct hors", salt).value()));
  CHECK_FALSE(is_key_of(*kept, password_key("correct horse", other).value()));
  PasswordKey hash{};
  std::copy(kept->hash.begin(), kept->hash.end(), hash.begin());
  CHECK_FALSE(is_key_of(*kept, hash));  // nobody joins with what the world keeps
}

TEST_CASE("a password that is too short or is no text is refused without its text", "[protocol]") {
  const auto why = [](const std::string& password) {
    const auto kept = join_password(password, {}, "builder");
    return kept ? std::string() : kept.error();
  };
  CHECK(why("1234567") == "the password has fewer than 8 characters: take some words");
  CHECK_FALSE(why("\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9").empty());  // 8 bytes, 4 characters
  CHECK_FALSE(why("e\xcc\x81"
                  "e\xcc\x81"
                  "e\xcc\x81"
                  "1234")
                  .empty());  // 7 characters in NFC
  CHECK(why("").find("fewer than 8") != std::string::npos);
  CHECK(why("eight\nchars").find("printable UTF-8") != std::string::npos);
  CHECK(why(std::string(kPasswordBytesMax + 1, 'a')).find("512") != std::string::npos);
  CHECK_FALSE(password_key("", {}).has_value());
  CHECK(password_key("short", {}).has_value());  // the length is a rule for new passwords only
}
