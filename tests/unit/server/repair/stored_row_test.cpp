// The bytes of rows and pages of SQLite, read without SQLite.
#include <catch2/catch.hpp>

#include "server/repair/page_cells.hpp"
#include "server/repair/stored_row.hpp"

namespace runstone::test {

TEST_CASE("a record of SQLite is decoded", "[repair]") {
  // A header of 7 bytes: NULL, 0, 1, 16 bits, a blob of 2 bytes, a text of 3.
  const Bytes record = {7, 0, 8, 9, 2, 16, 19, 0xff, 0xfe, 0xab, 0xcd, 'a', 'b', 'c'};
  const auto row = decode_stored_row(record);
  REQUIRE(row.has_value());
  CHECK(*row == StoredRow{std::monostate{}, std::int64_t{0}, std::int64_t{1}, std::int64_t{-2},
                          Bytes{0xab, 0xcd}, std::string("abc")});
  for (std::size_t size = 0; size < record.size(); ++size)
    CHECK_FALSE(decode_stored_row(ByteView(record).first(size)).has_value());
  Bytes longer = record;
  longer.push_back(0);
  CHECK(decode_stored_row(longer) == row);
}

TEST_CASE("a varint of SQLite has at most nine bytes", "[repair]") {
  const auto read = [](const Bytes& bytes) {
    std::size_t at = 0;
    return read_sqlite_varint(bytes, at);
  };
  CHECK(read({0x7f}) == 127);
  CHECK(read({0x81, 0x00}) == 128);
  CHECK(read(Bytes(9, 0xff)) == ~std::uint64_t{0});
  CHECK_FALSE(read({0x81}).has_value());
  CHECK_FALSE(read({}).has_value());
}

TEST_CASE("cells outside their page are left out and counted", "[repair]") {
  Bytes page(512, 0);
  page[0] = 10;  // a leaf of an index
  page[4] = 2;   // cells
  page[8] = 1;   // the first one at 256
  page[10] = 1;  // the second one at 511
  page[11] = 255;
  page[256] = 3;   // a record of 3 bytes
  page[511] = 40;  // a record that ends behind the page
  const auto found = cells_of(page, 0, page.size());
  REQUIRE(found.has_value());
  CHECK(found->cells.size() == 1);
  CHECK(found->cells.front().record_bytes == 3);
  CHECK(found->unreadable == 1);
  page[8] = 3;  // 256 and a bit that is ignored
  CHECK(cells_of(page, 0, page.size())->cells.size() == 1);
  page[0] = 7;
  CHECK_FALSE(cells_of(page, 0, page.size()).has_value());
  page[0] = 10;
  page[3] = 255;  // more cells than a page has
  CHECK_FALSE(cells_of(page, 0, page.size()).has_value());
}

}  // namespace runstone::test
