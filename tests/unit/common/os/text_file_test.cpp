#include "common/os/text_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

namespace {

const std::string kMark = "\xEF\xBB\xBF";

struct Folder : test::TempFolder {
  std::string write(const std::string& bytes) const {
    std::ofstream(*this / "text", std::ios::binary) << bytes;
    return *this / "text";
  }
};

}  // namespace

TEST_CASE_METHOD(Folder, "a byte order mark and the line ends of other systems are no text",
                 "[os]") {
  CHECK(*read_text_file(write(kMark + "one\r\ntwo\r\n"), 100) == "one\ntwo\n");
  CHECK(*read_text_file(write("one\ntwo"), 100) == "one\ntwo");
  CHECK(*read_text_file(write("a\rb\r\r\n" + kMark + "c"), 100) == "a\rb\r\n" + kMark + "c");
  CHECK(read_text_file(write(""), 100)->empty());
  CHECK(read_text_file(write(kMark), 100)->empty());
}

TEST_CASE_METHOD(Folder, "text that is not in UTF-8 is refused with what to do", "[os]") {
  for (const std::string mark : {"\xFF\xFE", "\xFE\xFF"}) {
    const auto text = read_text_file(write(mark + "x"), 100);
    REQUIRE_FALSE(text.has_value());
    CHECK(text.error() == (*this / "text") + ": is in UTF-16 or UTF-32: save it as UTF-8");
  }
}

TEST_CASE_METHOD(Folder, "a text file that is missing, a folder or too long is refused", "[os]") {
  CHECK(read_text_file(*this / "none", 9).error().find((*this / "none") + ": cannot be read") == 0);
  CHECK(read_text_file(path(), 9).error() == path() + ": is a folder");
  CHECK(read_text_file(write("0123456789"), 9).error() ==
        (*this / "text") + ": is larger than 9 bytes");
}

TEST_CASE_METHOD(Folder, "the first line of a file is without its end", "[os]") {
  for (const std::string text :
       {"secret", "secret\n", "secret\r\n", "secret\r", "secret\nmore\n"}) {
    CAPTURE(text);
    CHECK(*read_first_line(write(text)) == "secret");
    CHECK(*read_first_line(write(kMark + text)) == "secret");
    std::istringstream in(kMark + text);
    CHECK(first_line_of(in) == "secret");
  }
  CHECK(*read_first_line(write(" a b ")) == " a b ");
  CHECK(read_first_line(write("\r\nsecret")).error() ==
        (*this / "text") + ": its first line is empty");
  CHECK(read_first_line(write(kMark)).error() == (*this / "text") + ": its first line is empty");
}
